// One application of a planned sum: points in the units of their boxes, expansions, and the four kinds of work a chunk
// of boxes needs. Far: number type of the expansions; Near: of the direct sums.
#pragma once
#include <Eigen/Core>
#include <span>

#include "kernels/fmm/far_field.h"
#include "kernels/fmm/schedule.h"

namespace sherd::fmm {

// Structure of arrays: `columns` columns of `size` numbers.
template <class T>
class Columns {
 public:
  Columns() = default;
  Columns(std::size_t columns, std::size_t size) : size_(size), data_(columns * size, T(0)) {}
  T* column(std::size_t c) { return data_.data() + c * size_; }
  const T* column(std::size_t c) const { return data_.data() + c * size_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return data_.size() * sizeof(T); }

 private:
  std::size_t size_ = 0;
  std::vector<T> data_;
};

// A far field's translations in the number type that works with them. Surface vectors go component by component, each
// padded to kPairPad with rows and columns of zeros.
template <class T>
struct Operators {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  Operators(const FarField& field);

  std::size_t rank, columns, dim;
  std::size_t inner_size, outer_size;  // points without padding
  Columns<T> inner, outer;             // their coordinates
  Matrix up, down, spread, gather;     // rank x outer, outer x rank, inner x rank, rank x inner
  std::array<Matrix, 8> merge, split;  // child to parent, parent to child
  std::vector<Matrix> across;          // multipole to local
  std::array<std::vector<T>, 8> flip;  // signs of the coefficients under reflections
};

struct Problem {
  PairSum sum;
  PairConstants<double> constants;
  std::vector<FarField> fields;
};

template <class Far, class Near>
class Evaluator {
 public:
  // Normals where the sum needs them. Keeps references to problem, tree, lists and schedule.
  Evaluator(const Problem& problem, const Tree& tree, const InteractionLists& lists, const Schedule& schedule,
            const Vec3Column& sources, const Vec3Column& targets, const Vec3Column* source_normals,
            const Vec3Column* target_normals);

  // Everything that one application changes.
  struct State {
    std::size_t sets = 1;                            // of strengths
    std::span<double> out;                           // per set columns in the sum's order, as the targets were given
    std::vector<double> scale;                       // of the outputs, per set
    Columns<Near> strengths;                         // per set; sorted, root = 1
    Columns<Near> near;                              // outputs per set, padded by leaf
    Columns<Far> far;                                // likewise
    std::vector<std::vector<Far>> multipole, local;  // per field: [box][set][column][rank]
  };
  // strengths: per set columns in the sum's order without the normal's, finite. `factor` multiplies the outputs.
  State start(std::span<const double> strengths, std::span<double> out, std::size_t sets, double factor) const;
  void run(const Schedule::Task& task, State& state) const;

 private:
  struct BoxSources;
  void direct(const Chunk& chunk, State& state) const;
  void leaf_multipoles(std::size_t field, const Chunk& chunk, State& state) const;
  void merge_multipoles(std::size_t field, const Chunk& chunk, State& state) const;
  void translate(const typename Operators<Far>::Matrix& matrix,
                 std::span<const std::pair<Tree::Index, Tree::Index>> pairs, std::size_t width,
                 std::vector<Far>& coefficients) const;
  unsigned octant(Tree::Index box) const;  // in its parent
  void across(std::size_t field, std::size_t chunk, State& state) const;
  void leaf_locals(std::size_t field, const Chunk& chunk, State& state) const;
  void split_locals(std::size_t field, const Chunk& chunk, State& state) const;
  void evaluate_locals(std::size_t field, const Chunk& chunk, State& state) const;
  void evaluate_multipoles(std::size_t field, const Chunk& chunk, State& state) const;
  void finish(const Chunk& chunk, State& state) const;
  // Numbers a box's expansion has, all sets.
  std::size_t width(std::size_t field, const State& state) const;
  // The sources of a leaf in the units of a box, with the strengths that field.up takes.
  void gather_sources(std::size_t field, Tree::Index leaf, Tree::Index box, std::size_t set, const State& state,
                      BoxSources& out) const;
  // Adds what the sources of a leaf give on a surface about a box: all sets, each components() * surface.size()
  // numbers.
  void add_potential(std::size_t field, Tree::Index leaf, Tree::Index box, const Columns<Far>& surface,
                     const State& state, BoxSources& work, Far* potential) const;
  // Adds what densities on a surface about `box` give at the targets of `leaf`.
  void add_surface(std::size_t field, Tree::Index leaf, Tree::Index box, const Columns<Far>& surface, std::size_t count,
                   const Far* density, State& state, std::vector<Far>& work) const;
  Vec3 between(Tree::Index to, Tree::Index from) const;  // centres, root = 1

  const Problem& problem_;
  const Tree& tree_;
  const InteractionLists& lists_;
  const Schedule& schedule_;
  std::vector<Operators<Far>> operators_;
  Columns<Near> sources_, source_normals_;  // about their leaf's centre, root = 1; sorted
  Columns<Near> targets_, target_normals_;  // likewise, padded by leaf
};

extern template class Evaluator<float, float>;
extern template class Evaluator<float, double>;
extern template class Evaluator<double, double>;

}  // namespace sherd::fmm
