// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// vicinity trace: the drag on a point along a straight track.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

namespace vicinity::cli {

struct TraceOptions {
  std::filesystem::path field;
  std::string from, to;             ///< "x,y,z" [m]
  double speed = 0.1;               ///< [m/s]
  double rate = 1000;               ///< samples per second [Hz]
  double area = 1;                  ///< S [m²]; 1 is the paper's point robot
  std::string memory = "none";      ///< none, sustained, fading, short, rising
  std::string direction = "all";    ///< all, closing
  std::string traversal = "swept";  ///< swept, sampled
  std::string coding;  ///< name, or "32,25,20,...": in place of every object's; empty: the field's
  std::filesystem::path output;  ///< CSV; empty: standard output
  std::filesystem::path plot;    ///< .svg or .png; empty: none
};

/// Writes t,x,y,z,kind,object,rank,mu,mu_e,fx,fy,fz [s, m, N·s/m³, N], one line for each sample.
/// @return 0
/// Errors: throws Error for a file that is no field, a coding that does not fit it, and a track
/// that cannot be walked.
int trace(const TraceOptions& options, std::ostream& out, std::ostream& err);

}  // namespace vicinity::cli
