// Which expansions carry the far field of a pair sum, and what goes in and out of them.
#pragma once
#include <vector>

#include "kernels/fmm/pairs.h"
#include "kernels/fmm/translations.h"

namespace sherd::fmm {

// One family of expansions, `columns` independent ones a box.
struct FarField {
  // A strength of `up`: sum of factor * given strength; dipoles fall off one power faster, so their strengths scale
  // with the box.
  struct Term {
    std::size_t to, from;
    double factor;
    bool dipole;
  };
  TranslationOptions translations;
  std::size_t columns = 1;
  std::vector<Term> terms;
  PairSum up;    // sources -> potential on check surfaces: dim * columns numbers a point
  PairSum down;  // densities on surfaces (dim * columns numbers a point) -> the outputs of the sum
  PairConstants<double> up_constants, down_constants;
};

// `accuracy`: cut, inner and outer of every expansion; family and ratio follow from the sum.
std::vector<FarField> far_fields(PairSum sum, const PairConstants<double>& constants,
                                 const TranslationOptions& accuracy);

// Of the outputs of a sum: 1 for values, 2 for their derivatives (how fast they fall with the scale).
int output_power(PairSum sum, std::size_t output);
// Of its strengths: whether it is a dipole's, or the normal's.
bool is_dipole(PairSum sum, std::size_t strength);
// First of the three numbers of the source's normal among the strengths; strengths() when there is none.
std::size_t first_normal(PairSum sum);

}  // namespace sherd::fmm
