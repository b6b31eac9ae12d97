// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/coding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vicinity/geometry/error.h"

namespace vicinity {

double Coding::at_distance(double distance_vox, int m, int q) const noexcept {
  if (q == 0) return 0;
  const double ranks_away = std::max(distance_vox, 0.0) / m;
  if (!(ranks_away < q)) return 0;
  const auto n = static_cast<int>(ranks_away);
  const double near_side = of_rank(n + 1);
  const double far_side = n + 1 < q ? of_rank(n + 2) : 0.0;
  return near_side + (ranks_away - n) * (far_side - near_side);
}

void check_coding(const Coding& coding, int q, const std::string& where) {
  if (coding.mu.size() < static_cast<std::size_t>(std::max(q, 0))) {
    throw Error({.where = where,
                 .what = "the coding is shorter than the number of ranks",
                 .found = fmt::format("{} values for q: {}", coding.mu.size(), q),
                 .expected = "one viscosity for each rank",
                 .hint = "more values, a smaller q, or coding: jnd"});
  }
  // Body points carry their drag in single precision.
  constexpr double most = std::numeric_limits<float>::max();
  const auto is_viscosity = [](double mu) { return mu >= 0 && mu <= most; };
  for (std::size_t n = 0; n < coding.mu.size(); ++n) {
    if (is_viscosity(coding.mu[n])) continue;
    throw Error({.where = where,
                 .what = fmt::format("value {} of the coding is not a viscosity", n + 1),
                 .found = fmt::format("{}", coding.mu[n]),
                 .expected = fmt::format("zero to {:.3g}", most)});
  }
  if (!is_viscosity(coding.skin)) {
    throw Error({.where = where,
                 .what = "the skin is not a viscosity",
                 .found = fmt::format("{}", coding.skin),
                 .expected = fmt::format("zero to {:.3g}", most)});
  }
}

Coding named_coding(std::string_view name, int q) {
  constexpr std::array nonlinear = {32.0, 20.0, 13.0, 11.0, 10.0, 9.0, 8.0};  // then zeros
  constexpr std::array paper = {32.0, 25.0, 20.0, 17.0, 15.0, 13.0};
  // Jones & Hunter: viscosities less than 34 % apart are not told apart with certainty.
  constexpr double just_noticeable_ratio = 1.34;

  Coding coding;
  coding.mu.reserve(static_cast<std::size_t>(std::max(q, 0)));
  for (int n = 1; n <= q; ++n) {
    const auto at = static_cast<std::size_t>(n - 1);
    if (name == "linear") {
      coding.mu.push_back(std::max(0.0, 32.0 - 3.0 * (n - 1)));
    } else if (name == "nonlinear") {
      coding.mu.push_back(at < nonlinear.size() ? nonlinear[at] : 0.0);
    } else if (name == "jnd") {
      coding.mu.push_back(32.0 / std::pow(just_noticeable_ratio, n - 1));
    } else if (name == "paper" && at < paper.size()) {
      coding.mu.push_back(paper[at]);
    }
  }
  if (name == "paper" && q > static_cast<int>(paper.size())) {
    throw Error({.where = "coding",
                 .what = "the paper's coding has only six values",
                 .found = fmt::format("q: {}", q),
                 .expected = "q at most 6",
                 .hint = "coding: jnd, or a list of your own"});
  }
  if (name != "linear" && name != "nonlinear" && name != "jnd" && name != "paper") {
    throw Error({.where = "coding",
                 .what = "not the name of a coding",
                 .found = fmt::format("'{}'", name),
                 .expected = "linear, nonlinear, jnd, paper or a list of values"});
  }
  return coding;
}

}  // namespace vicinity
