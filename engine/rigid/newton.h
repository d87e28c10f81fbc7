// Contact problems that sweeps do not finish: heavy bodies on light ones, tall stacks.
#pragma once
#include "engine/rigid/row_terms.h"

namespace sherd {

// Method of multipliers: with weights rho per contact and the impulses p, q of the last round, the velocities minimize
//   1/2 |v - v0|^2_M + sum max(0, p + rho (target - v_n))^2 / (2 rho) + sum H(q - rho v_t) / rho
// where H is Huber's function with the disc's radius, friction times p: convex and once differentiable, so Newton's
// method with a line search finds them; the derivatives of the sums are the next impulses. Heavy weights make a round
// gain three digits whatever the masses (rho is 1e6 of the contact's own mass); friction's bound follows the normal
// impulses from round to round.
//
// `motions` come with the velocities of no impulse (v0), rows with the impulses to start from; both leave with the
// result when its residual is below `residual`, the one to beat, else as they came. Returns the residual, m/s.
Real solve_by_newton(std::span<Motion> motions, std::span<ContactRow> rows, std::span<const RowTerms> terms,
                     Real tolerance, Real residual);

}  // namespace sherd
