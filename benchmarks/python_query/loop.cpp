// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The C++ half of python_query.py: the loop that a C++ program would write, over the same points.

#include <cstddef>
#include <vector>

#include "vicinity/viscosity/field_file.h"

using vicinity::FieldSample;
using vicinity::Vec3;
using vicinity::ViscosityField;

extern "C" {

ViscosityField* loop_open(const char* path) {
  return new ViscosityField(vicinity::open_field(path));
}

void loop_close(ViscosityField* field) { delete field; }

/// Asks for every point, keeps every answer, and returns the sum of their viscosities.
double loop_query(const ViscosityField* field, const double* points, std::size_t count) {
  std::vector<FieldSample> samples(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double* p = points + 3 * n;
    samples[n] = field->at({p[0], p[1], p[2]});
  }
  double sum = 0;
  for (const FieldSample& sample : samples) sum += sample.viscosity;
  return sum;
}
}
