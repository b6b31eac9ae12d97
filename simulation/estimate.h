// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Numbers with the range that they are known to.
#pragma once

#include <vector>

namespace vicinity {

/// A value, and between which ends it lies with 95 % confidence.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// A share: `hits` of `trials`, by Wilson's interval (1927). 0 to 1 where there was no trial.
Estimate share_of(int hits, int trials);

/// A mean, by Student's t for few values. No width where there are fewer than two values.
Estimate mean_of(const std::vector<double>& values);

/// Whether a is certainly below b: their ranges do not meet.
inline bool below(const Estimate& a, const Estimate& b) { return a.high < b.low; }

}  // namespace vicinity
