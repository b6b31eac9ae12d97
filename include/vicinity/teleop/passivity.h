// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// How much sampled drag a device bears before the drag feeds its motion instead of eating it.
///
/// The setting of every rule: position is read each period T, differentiated to
/// v^_k = (x_k - x_{k-1})/T, and the force F_k = -B v^_{k-d} is held until the next period. With
/// v_k the mean velocity of the period that ends at x_k, the computer does the work
/// -T B v_{k-d} v_{k+1} on the device, while the device's own damping b eats at least T b v_{k+1}²
/// (Cauchy-Schwarz on the integral of v²). Everything below is what keeps the sum of both from
/// feeding anyone: pure mathematics, for the constructor, not for the tick.
///
/// Sources: Colgate & Schenkel 1997 (the passivity test of a sampled environment), Abbott & Okamura
/// 2005 (quantisation against friction); where neither is named the derivation stands beside the
/// function.
#pragma once

#include <complex>
#include <functional>

namespace vicinity {

/// Transfer function F(z) from the true velocity to the filtered one, asked on |z| = 1, z != 1.
using VelocityFilter = std::function<std::complex<double>(std::complex<double> z)>;

/// Mean of the last M one-period differences, which is the M-sample difference: no more than
/// (x_k - x_{k-M})/(M T). Errors: throws Error unless samples >= 1.
VelocityFilter difference_filter(int samples);

/// v^_k = a v^_{k-1} + (1 - a)(x_k - x_{k-1})/T. Errors: throws Error unless 0 <= pole < 1.
VelocityFilter first_order_filter(double pole);

/// Rule 3: the b/B a constant drag B needs, so that no passive operator gets energy out:
///
///   max over theta in (0, pi] of -Re{e^{-j(1+d) theta} F(e^{j theta})}
///
/// 1 without a filter, whatever T and d (rule 2). It holds for a constant B only: where B may jump,
/// a filter buys nothing, see window_factor().
///
/// @param delay     d, whole periods between measuring and commanding, >= 0
/// @param variation how often the filter's phase can turn between 0 and pi, at least its memory in
///                  samples; sets how finely theta is searched
/// Errors: throws Error for a delay below 0 or a variation below 1.
double needed_damping_ratio(const VelocityFilter& filter, int delay, int variation = 64);

/// Rule 2: angular frequency of the buzz that too much drag feeds first: pi/((1+d)T) [rad/s].
double buzz_frequency(double period_s, int delay) noexcept;

/// Rule 5: c such that c B is passive where the device goes on holding a force for up to N periods:
/// c = 2/(1 + sqrt N).
///
/// Over one hold w_1..w_N of a force made from v, the last velocity of the hold before, the
/// computer feeds in at most T c B |v| |w_1 + ... + w_N|. Split by 2|v||q| <= g v² + q²/g, g = sqrt
/// N, a hold pays for itself if (c B/2)(g e_N e_N' + 1 1'/g) <= b I, where e_N e_N' picks the
/// hold's last velocity, which the next hold will meet. Both matrices have the norm sqrt N, and the
/// largest eigenvalue of their sum is sqrt N + 1. A shorter hold needs less, so that holds
/// of any lengths up to N may be mixed.
double hold_factor(int longest_hold);

/// c such that c D is passive where v^ is the mean over some number of the latest periods, up to M,
/// that may change with every tick and every axis, and D may jump.
///
/// A fixed number M needs no factor: each v_{k-i} is then used with weight 1/M in M ticks, every
/// use costs what a plain difference costs, and the costs average to the same. Where the number
/// varies, let row k of W hold the weights of tick k: W D adds no more than the norm |W| allows.
/// Rows sum to 1; a column sums, over the ticks that still average over one and the same period, to
/// at most H = 1 + 1/2 + ... + 1/M. Hence |W| <= sqrt H, c = 1/sqrt H. Holding for N periods
/// repeats rows: c = 1/sqrt(N H). M = 1 gives hold_factor(N), which is sharp. This one is not: no
/// sequence of windows is known that needs less than c = 1, but none of that has been proven. With
/// a damping matrix that couples axes, all axes must use one window.
double window_factor(int longest_window, int longest_hold = 1);

/// Rule 6: the largest B T/m with nobody holding, b = 0: 2 tan(pi/(4(1+d))).
///
/// Exact integration over a period gives z^{d+1}(z - 1) + (g/2)(z + 1) = 0 for the mean velocity,
/// g = B T/m. A root on the circle, z = e^{j theta}, needs g/2 = tan(theta/2) and
/// (1+d) theta = pi/2; the first one to get there is this.
double mass_limit(int delay);

/// Rule 7: the largest B [N·s/m] at which one step of the encoder does not move the device against
/// its own dry friction: f_c M T/Delta. One step Delta in a window of M T seconds reads as
/// Delta/(M T) and is answered with a force that dry friction must be able to hold.
///
/// @param dry_friction  f_c, what the device certainly has   [N]
/// @param window_s      M T                                  [s]
/// @param encoder_step  Delta                                [m]
double quantisation_limit(double dry_friction, double window_s, double encoder_step) noexcept;

}  // namespace vicinity
