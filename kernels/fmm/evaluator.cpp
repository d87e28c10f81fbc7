#include "kernels/fmm/evaluator.h"

#include <algorithm>
#include <cmath>

#include "kernels/core/parallel.h"

namespace sherd::fmm {
namespace {

using Eigen::Index;

template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using ConstMap = Eigen::Map<const Matrix<T>>;
template <class T>
using Map = Eigen::Map<Matrix<T>>;

constexpr std::size_t kGrain = 4096;

template <class T>
PairConstants<T> cast(const PairConstants<double>& c) {
  return {static_cast<T>(c.a), static_cast<T>(c.b), static_cast<T>(c.c), static_cast<T>(c.lambda),
          static_cast<T>(c.mu)};
}

// The power of two just above the largest magnitude, 1 for zeros: scaling by it is exact.
double binary_scale(double largest) {
  return largest > 0 ? std::ldexp(1.0, std::ilogb(largest) + 1) : 1.0;
}

}  // namespace

template <class Far, class Near>
Evaluator<Far, Near>::Evaluator(const Problem& problem, const Tree& tree, const InteractionLists& lists,
                                const Schedule& schedule, const Vec3Column& sources, const Vec3Column& targets,
                                const Vec3Column* source_normals, const Vec3Column* target_normals)
    : problem_(problem),
      tree_(tree),
      lists_(lists),
      schedule_(schedule),
      sources_(3, sources.size()),
      source_normals_(source_normals ? 3 : 0, sources.size()),
      targets_(3, schedule.padded_size),
      target_normals_(target_normals ? 3 : 0, schedule.padded_size) {
  for (const FarField& f : problem.fields) operators_.emplace_back(f);
  parallel_for(tree.box_count(), 64, [&](std::size_t box) {
    const auto b = static_cast<Tree::Index>(box);
    if (!tree.leaf(b)) return;
    const Vec3 centre = tree.centre(b);
    for (Tree::Index i = tree.sources[b].begin; i < tree.sources[b].end; ++i) {
      const Vec3 x = (sources[tree.source_order[i]] - centre) / tree.size;
      for (int k = 0; k < 3; ++k) {
        sources_.column(static_cast<std::size_t>(k))[i] = static_cast<Near>(x[k]);
        if (source_normals)
          source_normals_.column(static_cast<std::size_t>(k))[i] =
              static_cast<Near>((*source_normals)[tree.source_order[i]][k]);
      }
    }
    const Tree::Range t = tree.targets[b];
    for (std::size_t i = 0; i < padded_count(t.size()); ++i) {
      const std::size_t at = schedule.padded[b] + i;
      const std::uint32_t given = tree.target_order[std::min<std::size_t>(t.begin + i, t.end - 1)];
      const Vec3 x = (targets[given] - centre) / tree.size;
      for (int k = 0; k < 3; ++k) {
        targets_.column(static_cast<std::size_t>(k))[at] = static_cast<Near>(x[k]);
        if (target_normals)
          target_normals_.column(static_cast<std::size_t>(k))[at] = static_cast<Near>((*target_normals)[given][k]);
      }
    }
  });
}

template <class Far, class Near>
typename Evaluator<Far, Near>::State Evaluator<Far, Near>::start(std::span<const double> strengths,
                                                                 std::span<double> out, std::size_t sets,
                                                                 double factor) const {
  const PairShape shape = pair_shape(problem_.sum);
  const std::size_t own = first_normal(problem_.sum), n = sources_.size();
  const auto root_factor = [&](std::size_t k) { return is_dipole(problem_.sum, k) ? 1 / tree_.size : 1.0; };
  State s;
  s.sets = sets, s.out = out;
  s.strengths = Columns<Near>(sets * own, n);
  for (std::size_t set = 0; set < sets; ++set) {
    const std::span<const double> given = strengths.subspan(set * own * n, own * n);
    std::vector<double> partial((n + kGrain - 1) / kGrain, 0);
    parallel_for_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
      double largest = 0;
      for (std::size_t k = 0; k < own; ++k)
        for (std::size_t i = begin; i < end; ++i)
          largest = std::max(largest, std::abs(given[k * n + i] * root_factor(k)));
      partial[begin / kGrain] = largest;
    });
    const double unit = binary_scale(partial.empty() ? 0 : *std::max_element(partial.begin(), partial.end()));
    s.scale.push_back(factor * unit);
    parallel_for_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = 0; k < own; ++k) {
        const double f = root_factor(k) / unit;
        for (std::size_t i = begin; i < end; ++i)
          s.strengths.column(set * own + k)[i] = static_cast<Near>(given[k * n + tree_.source_order[i]] * f);
      }
    });
  }
  s.near = Columns<Near>(sets * shape.outputs, schedule_.padded_size);
  s.far = Columns<Far>(sets * shape.outputs, schedule_.padded_size);
  for (std::size_t f = 0; f < operators_.size(); ++f) {
    s.multipole.emplace_back(tree_.box_count() * width(f, s), Far(0));
    s.local.emplace_back(tree_.box_count() * width(f, s), Far(0));
  }
  return s;
}

template <class Far, class Near>
std::size_t Evaluator<Far, Near>::width(std::size_t field, const State& state) const {
  return state.sets * operators_[field].columns * operators_[field].rank;
}

template <class Far, class Near>
void Evaluator<Far, Near>::run(const Schedule::Task& task, State& state) const {
  const Chunk& chunk = schedule_.chunks()[task.chunk];
  switch (task.kind) {
    case TaskKind::kDirect:
      direct(chunk, state);
      break;
    case TaskKind::kUp:
      for (std::size_t f = 0; f < operators_.size(); ++f)
        leaf_multipoles(f, chunk, state), merge_multipoles(f, chunk, state);
      break;
    case TaskKind::kAcross:
      for (std::size_t f = 0; f < operators_.size(); ++f) across(f, task.chunk, state), leaf_locals(f, chunk, state);
      break;
    case TaskKind::kDown:
      for (std::size_t f = 0; f < operators_.size(); ++f) {
        split_locals(f, chunk, state);
        evaluate_locals(f, chunk, state);
        evaluate_multipoles(f, chunk, state);
      }
      finish(chunk, state);
      break;
  }
}

template <class Far, class Near>
Vec3 Evaluator<Far, Near>::between(Tree::Index to, Tree::Index from) const {
  return (tree_.centre(to) - tree_.centre(from)) / tree_.size;
}

template <class Far, class Near>
void Evaluator<Far, Near>::direct(const Chunk& chunk, State& state) const {
  const PairFunction<Near> sum = pair_function<Near>(problem_.sum);
  const PairConstants<Near> constants = cast<Near>(problem_.constants);
  const PairShape shape = pair_shape(problem_.sum);
  const std::size_t normal = first_normal(problem_.sum);
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b) {
    if (!tree_.leaf(b) || tree_.targets[b].size() == 0) continue;
    const std::size_t at = schedule_.padded[b];
    PairTargets<Near> targets{};
    targets.count = padded_count(tree_.targets[b].size());
    for (std::size_t k = 0; k < 3; ++k) {
      targets.x[k] = targets_.column(k) + at;
      targets.normal[k] = shape.target_normals ? target_normals_.column(k) + at : nullptr;
    }
    for (const Tree::Index a : lists_.near[b]) {
      const Vec3 d = between(b, a);
      const Near shift[3] = {static_cast<Near>(d.x), static_cast<Near>(d.y), static_cast<Near>(d.z)};
      const Tree::Range r = tree_.sources[a];
      PairSources<Near> sources{};
      sources.count = r.size();
      for (std::size_t k = 0; k < 3; ++k) sources.x[k] = sources_.column(k) + r.begin;
      for (std::size_t set = 0; set < state.sets; ++set) {
        for (std::size_t k = 0; k < shape.strengths; ++k)
          sources.strength[k] =
              (k < normal ? state.strengths.column(set * normal + k) : source_normals_.column(k - normal)) + r.begin;
        Near* out[kMaxOutputs];
        for (std::size_t k = 0; k < shape.outputs; ++k) out[k] = state.near.column(set * shape.outputs + k) + at;
        sum(sources, targets, shift, constants, out);
      }
    }
  }
}

template <class Far, class Near>
struct Evaluator<Far, Near>::BoxSources {
  std::vector<Far> data;
  PairSources<Far> sources{};
};

template <class Far, class Near>
void Evaluator<Far, Near>::gather_sources(std::size_t field, Tree::Index leaf, Tree::Index box, std::size_t set,
                                          const State& state, BoxSources& out) const {
  const FarField& f = problem_.fields[field];
  const std::size_t n = tree_.sources[leaf].size(), first = tree_.sources[leaf].begin;
  const std::size_t strengths = pair_shape(f.up).strengths, normal = first_normal(problem_.sum);
  const Near unit = std::ldexp(Near(1), tree_.level[box]);
  const Vec3 d = between(leaf, box);
  out.data.assign((3 + strengths) * n, Far(0));
  for (std::size_t k = 0; k < 3; ++k) {
    const Near shift = static_cast<Near>(d[static_cast<int>(k)]);
    Far* x = out.data.data() + k * n;
    for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<Far>((sources_.column(k)[first + i] + shift) * unit);
    out.sources.x[k] = x;
  }
  for (const FarField::Term& t : f.terms) {
    const Near* from =
        (t.from < normal ? state.strengths.column(set * normal + t.from) : source_normals_.column(t.from - normal)) +
        first;
    const Near factor = static_cast<Near>(t.factor) * (t.dipole ? unit : Near(1));
    Far* to = out.data.data() + (3 + t.to) * n;
    for (std::size_t i = 0; i < n; ++i) to[i] += static_cast<Far>(from[i] * factor);
  }
  for (std::size_t k = 0; k < strengths; ++k) out.sources.strength[k] = out.data.data() + (3 + k) * n;
  out.sources.count = n;
}

template <class Far, class Near>
void Evaluator<Far, Near>::add_potential(std::size_t field, Tree::Index leaf, Tree::Index box,
                                         const Columns<Far>& surface, const State& state, BoxSources& work,
                                         Far* potential) const {
  const FarField& f = problem_.fields[field];
  const std::size_t components = operators_[field].dim * operators_[field].columns;
  const PairTargets<Far> check{surface.size(), {surface.column(0), surface.column(1), surface.column(2)}, {}};
  for (std::size_t set = 0; set < state.sets; ++set) {
    gather_sources(field, leaf, box, set, state, work);
    Far* out[kMaxOutputs];
    for (std::size_t k = 0; k < components; ++k) out[k] = potential + (set * components + k) * surface.size();
    constexpr Far kNone[3] = {0, 0, 0};
    pair_function<Far>(f.up)(work.sources, check, kNone, cast<Far>(f.up_constants), out);
  }
}

template <class Far, class Near>
void Evaluator<Far, Near>::leaf_multipoles(std::size_t field, const Chunk& chunk, State& state) const {
  const Operators<Far>& o = operators_[field];
  const std::size_t stride = o.dim * o.outer.size(), w = width(field, state), columns = w / o.rank;
  std::vector<Tree::Index> leaves;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b)
    if (tree_.leaf(b) && tree_.sources[b].size() > 0) leaves.push_back(b);
  constexpr std::size_t kBatch = 32;
  std::vector<Far> potential;
  BoxSources sources;
  Matrix<Far> multipole;
  for (std::size_t first = 0; first < leaves.size(); first += kBatch) {
    const std::size_t n = std::min(kBatch, leaves.size() - first);
    potential.assign(n * columns * stride, Far(0));
    for (std::size_t l = 0; l < n; ++l)
      add_potential(field, leaves[first + l], leaves[first + l], o.outer, state, sources,
                    potential.data() + l * columns * stride);
    multipole.noalias() =
        o.up * ConstMap<Far>(potential.data(), static_cast<Index>(stride), static_cast<Index>(n * columns));
    for (std::size_t l = 0; l < n; ++l)
      std::copy_n(multipole.data() + l * w, w, state.multipole[field].data() + leaves[first + l] * w);
  }
}

// The coefficients of each pair's second box += matrix * those of its first.
template <class Far, class Near>
void Evaluator<Far, Near>::translate(const typename Operators<Far>::Matrix& matrix,
                                     std::span<const std::pair<Tree::Index, Tree::Index>> pairs, std::size_t w,
                                     std::vector<Far>& coefficients) const {
  if (pairs.empty()) return;
  const auto rank = matrix.cols(), columns = static_cast<Index>(pairs.size() * w) / rank;
  Matrix<Far> in(rank, columns);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    std::copy_n(coefficients.data() + pairs[i].first * w, w, in.data() + i * w);
  const Matrix<Far> out = matrix * in;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t k = 0; k < w; ++k) coefficients[pairs[i].second * w + k] += out.data()[i * w + k];
}

template <class Far, class Near>
unsigned Evaluator<Far, Near>::octant(Tree::Index box) const {
  const auto& a = tree_.anchor[box];
  return (a[0] & 1) | (a[1] & 1) << 1 | (a[2] & 1) << 2;
}

template <class Far, class Near>
void Evaluator<Far, Near>::merge_multipoles(std::size_t field, const Chunk& chunk, State& state) const {
  std::array<std::vector<std::pair<Tree::Index, Tree::Index>>, 8> pairs;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b)
    for (Tree::Index c = tree_.children[b].begin; c < tree_.children[b].end; ++c)
      if (tree_.sources[c].size() > 0) pairs[octant(c)].push_back({c, b});
  for (std::size_t o = 0; o < 8; ++o)
    translate(operators_[field].merge[o], pairs[o], width(field, state), state.multipole[field]);
}

template <class Far, class Near>
void Evaluator<Far, Near>::across(std::size_t field, std::size_t chunk, State& state) const {
  const Operators<Far>& o = operators_[field];
  const std::span<const FarExchange> exchanges = schedule_.exchanges(chunk);
  const std::size_t w = width(field, state), sets = w / o.rank, batch = std::max<std::size_t>(1, 192 / sets);
  std::vector<Far> in(batch * w), out(batch * w);
  const Far* multipole = state.multipole[field].data();
  Far* local = state.local[field].data();
  for (std::size_t first = 0; first < exchanges.size();) {
    std::size_t last = first + 1;
    while (last < exchanges.size() && last - first < batch && exchanges[last].matrix == exchanges[first].matrix) ++last;
    for (std::size_t i = first; i < last; ++i) {
      const Far *from = multipole + exchanges[i].source * w, *sign = o.flip[exchanges[i].flips].data();
      Far* to = in.data() + (i - first) * w;
      for (std::size_t c = 0; c < sets; ++c)
        for (std::size_t k = 0; k < o.rank; ++k) to[c * o.rank + k] = from[c * o.rank + k] * sign[k];
    }
    const auto columns = static_cast<Index>((last - first) * sets), rank = static_cast<Index>(o.rank);
    Map<Far>(out.data(), rank, columns).noalias() =
        o.across[exchanges[first].matrix] * ConstMap<Far>(in.data(), rank, columns);
    for (std::size_t i = first; i < last; ++i) {
      const Far *from = out.data() + (i - first) * w, *sign = o.flip[exchanges[i].flips].data();
      Far* to = local + exchanges[i].target * w;
      for (std::size_t c = 0; c < sets; ++c)
        for (std::size_t k = 0; k < o.rank; ++k) to[c * o.rank + k] += from[c * o.rank + k] * sign[k];
    }
    first = last;
  }
}

template <class Far, class Near>
void Evaluator<Far, Near>::leaf_locals(std::size_t field, const Chunk& chunk, State& state) const {
  const Operators<Far>& o = operators_[field];
  const std::size_t stride = o.dim * o.inner.size(), w = width(field, state), columns = w / o.rank;
  std::vector<Far> potential;
  BoxSources sources;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b) {
    if (lists_.local[b].empty()) continue;
    potential.assign(columns * stride, Far(0));
    for (const Tree::Index a : lists_.local[b]) add_potential(field, a, b, o.inner, state, sources, potential.data());
    const auto count = static_cast<Index>(columns);
    Map<Far>(state.local[field].data() + b * w, static_cast<Index>(o.rank), count).noalias() +=
        o.gather * ConstMap<Far>(potential.data(), static_cast<Index>(stride), count);
  }
}

template <class Far, class Near>
void Evaluator<Far, Near>::split_locals(std::size_t field, const Chunk& chunk, State& state) const {
  if (chunk.begin == 0) return;  // the root
  std::array<std::vector<std::pair<Tree::Index, Tree::Index>>, 8> pairs;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b)
    if (tree_.targets[b].size() > 0) pairs[octant(b)].push_back({tree_.parent[b], b});
  for (std::size_t o = 0; o < 8; ++o)
    translate(operators_[field].split[o], pairs[o], width(field, state), state.local[field]);
}

template <class Far, class Near>
void Evaluator<Far, Near>::add_surface(std::size_t field, Tree::Index leaf, Tree::Index box,
                                       const Columns<Far>& surface, std::size_t count, const Far* density, State& state,
                                       std::vector<Far>& work) const {
  const FarField& f = problem_.fields[field];
  const std::size_t n = padded_count(tree_.targets[leaf].size()), at = schedule_.padded[leaf];
  const PairShape shape = pair_shape(f.down);
  const Near unit = std::ldexp(Near(1), tree_.level[box]);
  const Vec3 d = between(leaf, box);
  work.assign((6 + shape.outputs) * n, Far(0));
  PairTargets<Far> targets{};
  targets.count = n;
  for (std::size_t k = 0; k < 3; ++k) {
    const Near shift = static_cast<Near>(d[static_cast<int>(k)]);
    Far* x = work.data() + k * n;
    for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<Far>((targets_.column(k)[at + i] + shift) * unit);
    targets.x[k] = x;
    if (!shape.target_normals) continue;
    Far* normal = work.data() + (3 + k) * n;
    for (std::size_t i = 0; i < n; ++i) normal[i] = static_cast<Far>(target_normals_.column(k)[at + i]);
    targets.normal[k] = normal;
  }
  PairSources<Far> sources{};
  sources.count = count;
  for (std::size_t k = 0; k < 3; ++k) sources.x[k] = surface.column(k);
  const std::size_t components = operators_[field].dim * operators_[field].columns;
  Far* out[kMaxOutputs];
  for (std::size_t k = 0; k < shape.outputs; ++k) out[k] = work.data() + (6 + k) * n;
  for (std::size_t set = 0; set < state.sets; ++set) {
    if (set > 0) std::fill(work.begin() + static_cast<std::ptrdiff_t>(6 * n), work.end(), Far(0));
    for (std::size_t k = 0; k < shape.strengths; ++k)
      sources.strength[k] = density + (set * components + k) * surface.size();
    constexpr Far kNone[3] = {0, 0, 0};
    pair_function<Far>(f.down)(sources, targets, kNone, cast<Far>(f.down_constants), out);
    for (std::size_t k = 0; k < shape.outputs; ++k) {
      const Far scale = std::ldexp(Far(1), tree_.level[box] * output_power(problem_.sum, k));
      Far* far = state.far.column(set * shape.outputs + k) + at;
      for (std::size_t i = 0; i < n; ++i) far[i] += out[k][i] * scale;
    }
  }
}

template <class Far, class Near>
void Evaluator<Far, Near>::evaluate_locals(std::size_t field, const Chunk& chunk, State& state) const {
  const Operators<Far>& o = operators_[field];
  const std::size_t w = width(field, state), columns = w / o.rank, stride = o.outer.size();
  std::vector<Tree::Index> leaves;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b)
    if (tree_.leaf(b) && tree_.targets[b].size() > 0) leaves.push_back(b);
  constexpr std::size_t kBatch = 32;
  Matrix<Far> local, density;
  std::vector<Far> work;
  for (std::size_t first = 0; first < leaves.size(); first += kBatch) {
    const std::size_t n = std::min(kBatch, leaves.size() - first);
    local.resize(static_cast<Index>(o.rank), static_cast<Index>(n * columns));
    for (std::size_t l = 0; l < n; ++l)
      std::copy_n(state.local[field].data() + leaves[first + l] * w, w, local.data() + l * w);
    density.noalias() = o.down * local;
    for (std::size_t l = 0; l < n; ++l)
      add_surface(field, leaves[first + l], leaves[first + l], o.outer, o.outer_size,
                  density.data() + l * columns * o.dim * stride, state, work);
  }
}

template <class Far, class Near>
void Evaluator<Far, Near>::evaluate_multipoles(std::size_t field, const Chunk& chunk, State& state) const {
  const Operators<Far>& o = operators_[field];
  const std::size_t w = width(field, state), columns = w / o.rank;
  Matrix<Far> density;
  std::vector<Far> work;
  for (Tree::Index b = chunk.begin; b < chunk.end; ++b)
    for (const Tree::Index a : lists_.multipole[b]) {
      density.noalias() = o.spread * ConstMap<Far>(state.multipole[field].data() + a * w, static_cast<Index>(o.rank),
                                                   static_cast<Index>(columns));
      add_surface(field, b, a, o.inner, o.inner_size, density.data(), state, work);
    }
}

template <class Far, class Near>
void Evaluator<Far, Near>::finish(const Chunk& chunk, State& state) const {
  const std::size_t outputs = pair_shape(problem_.sum).outputs, n = tree_.target_order.size();
  for (std::size_t k = 0; k < state.sets * outputs; ++k) {
    const double scale = state.scale[k / outputs] / std::pow(tree_.size, output_power(problem_.sum, k % outputs));
    for (Tree::Index b = chunk.begin; b < chunk.end; ++b) {
      if (!tree_.leaf(b)) continue;
      const Near* near = state.near.column(k) + schedule_.padded[b];
      const Far* far = state.far.column(k) + schedule_.padded[b];
      for (Tree::Index i = 0; i < tree_.targets[b].size(); ++i)
        state.out[k * n + tree_.target_order[tree_.targets[b].begin + i]] =
            (static_cast<double>(near[i]) + static_cast<double>(far[i])) * scale;
    }
  }
}

template class Evaluator<float, float>;
template class Evaluator<float, double>;
template class Evaluator<double, double>;

}  // namespace sherd::fmm
