#include "kernels/fmm/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <variant>

#include "kernels/core/error.h"
#include "kernels/core/parallel.h"
#include "kernels/core/trace.h"
#include "kernels/fmm/accuracy.h"
#include "kernels/fmm/evaluator.h"
#include "kernels/fmm/rbf.h"

namespace sherd::fmm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Constants of the order of one, so that single precision holds in any units, and the factor they lost.
PairConstants<double> unit_constants(PairSum sum, PairConstants<double> c, double& factor) {
  const auto scale = [&factor](std::initializer_list<double*> values) {
    double largest = 0;
    for (const double* v : values) {
      if (!std::isfinite(*v)) throw InputError("fast multipole method: a constant is not finite");
      largest = std::max(largest, std::abs(*v));
    }
    if (largest == 0) return;
    factor *= largest;
    for (double* v : values) *v /= largest;
  };
  switch (sum) {
    case PairSum::kLaplaceValue:
    case PairSum::kLaplaceGradient:
    case PairSum::kDipoleValue:
    case PairSum::kDipoleGradient:
      scale({&c.c});
      break;
    case PairSum::kElasticValue:
    case PairSum::kElasticGradient:
      scale({&c.a, &c.b, &c.c});
      break;
    default:
      scale({&c.a, &c.b});
  }
  if (sum == PairSum::kKelvinStress || sum == PairSum::kKelvinTraction) scale({&c.lambda, &c.mu});
  return c;
}

void require_normals(const char* what, bool needed, const Vec3Column* normals, std::size_t points) {
  if (needed && (!normals || normals->size() != points))
    throw InputError(fmt::format("fast multipole method: the sum needs one {} normal a point ({} for {} points)", what,
                                 normals ? normals->size() : 0, points));
  if (!needed) return;
  for (std::size_t i = 0; i < points; ++i)
    if (!is_finite((*normals)[i]))
      throw InputError(fmt::format("fast multipole method: {} normal {} is not finite", what, i));
}

// Far below any crossover: such plans do without translations, which take seconds to make at fine tolerances.
constexpr double kAlwaysDirect = 1e6;
constexpr std::size_t kDirectLeaf = 128;

ListOptions everything_direct() {
  constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();
  return {.multipole_from = kNever, .local_from = kNever, .direct_below = kNever};
}

struct Layout {
  std::unique_ptr<Tree> tree;
  std::size_t leaf_size = 0;
};

// Leaf size and root by the cost model. Small leaves take longest to count and are passed over once the cost rises.
Layout choose_layout(const Points& p, const PlanOptions& o, const CostModel& model, const ListOptions& lists) {
  Layout best;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t most = std::max(p.sources.size(), p.targets.size());
  std::vector<std::size_t> sizes{304, 208, 144, 96, 64, 40};
  if (o.scheme == Scheme::kRbfSphere) sizes.insert(sizes.begin(), {960, 640, 448});  // dear translations
  if (o.leaf_size > 0) sizes = {o.leaf_size};
  for (const Real stretch : {1.0, 1.2, 1.5}) {
    if (stretch > 1 && (o.leaf_size > 0 || most < 2000)) break;
    const SortedPoints sorted(p.sources, p.targets, stretch);
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::size_t size : sizes) {
      auto tree = std::make_unique<Tree>(sorted, TreeOptions{size});
      const double c = cost(model, *tree, count_interactions(*tree, lists));
      if (c > 1.02 * lowest) break;
      lowest = std::min(lowest, c);
      if (c < least) least = c, best.tree = std::move(tree), best.leaf_size = size;
    }
  }
  return best;
}

}  // namespace

struct Plan::Impl {
  PlanStatistics statistics;
  Problem problem;
  double factor = 1;
  std::size_t sources, targets, sphere_bytes = 0;
  std::unique_ptr<Tree> tree;
  std::unique_ptr<InteractionLists> lists;
  std::unique_ptr<Schedule> schedule;
  std::variant<std::monostate, Evaluator<float, float>, Evaluator<float, double>, Evaluator<double, double>> evaluator;

  Impl(PairSum sum, const PairConstants<double>& constants, const Points& p, const PlanOptions& o)
      : sources(p.sources.size()), targets(p.targets.size()) {
    const PairShape shape = pair_shape(sum);
    require_normals("source", first_normal(sum) < shape.strengths, p.source_normals, sources);
    require_normals("target", shape.target_normals, p.target_normals, targets);
    problem.sum = sum, problem.constants = unit_constants(sum, constants, factor);
    const TranslationOptions accuracy = accuracy_for(o.tolerance);
    const double all = static_cast<double>(sources) * static_cast<double>(targets);
    statistics.direct = o.scheme == Scheme::kDirect || (o.leaf_size == 0 && all <= kAlwaysDirect);
    const bool single_far = o.arithmetic != Arithmetic::kDouble, single_near = o.arithmetic == Arithmetic::kFloat;
    auto start = Clock::now();
    CostModel model;
    std::shared_ptr<const Translations> first;
    ListOptions list_options = everything_direct();
    if (!statistics.direct) {
      problem.fields = far_fields(sum, problem.constants, accuracy);
      if (o.scheme == Scheme::kRbfSphere) choose_spheres(o, single_far);
      model = cost_model(sum, problem.fields, single_far, single_near);
      first = translations(problem.fields[0].translations);
      for (const FarField& f : problem.fields) statistics.rank.push_back(translations(f.translations)->rank);
      list_options.multipole_from = list_options.local_from = first->inner.size();
      list_options.direct_below = static_cast<std::size_t>(model.far / model.pair);
    }
    statistics.translations_seconds = seconds_since(start);

    start = Clock::now();
    PlanOptions layout_options = o;
    if (statistics.direct && o.leaf_size == 0) layout_options.leaf_size = kDirectLeaf;
    Layout layout = choose_layout(p, layout_options, model, list_options);
    tree = std::move(layout.tree);
    if (!statistics.direct && o.leaf_size == 0) {
      const double planned = cost(model, *tree, count_interactions(*tree, list_options));
      statistics.direct = all * model.pair * 1.1 <= planned;
      if (statistics.direct) list_options = everything_direct();
    }
    statistics.leaf_size = layout.leaf_size;
    statistics.tree_seconds = seconds_since(start);

    start = Clock::now();
    const ListCounts counts = count_interactions(*tree, list_options);
    statistics.direct_pairs = counts.direct_pairs, statistics.far_pairs = counts.far_pairs;
    statistics.boxes = tree->box_count(), statistics.levels = static_cast<std::size_t>(tree->level_count());
    for (Tree::Index b = 0; b < tree->box_count(); ++b) statistics.leaves += tree->leaf(b) ? 1 : 0;
    refuse_too_large(o, counts, single_far, single_near);
    lists = std::make_unique<InteractionLists>(*tree, list_options);
    schedule = std::make_unique<Schedule>(*tree, *lists, first.get());
    statistics.lists_seconds = seconds_since(start);

    start = Clock::now();
    const Vec3Column* source_normals = first_normal(sum) < shape.strengths ? p.source_normals : nullptr;
    const Vec3Column* target_normals = shape.target_normals ? p.target_normals : nullptr;
    const auto make = [&](auto type) {
      using E = typename decltype(type)::type;
      evaluator.emplace<E>(problem, *tree, *lists, *schedule, p.sources, p.targets, source_normals, target_normals);
    };
    if (single_near)
      make(std::type_identity<Evaluator<float, float>>{});
    else if (single_far)
      make(std::type_identity<Evaluator<float, double>>{});
    else
      make(std::type_identity<Evaluator<double, double>>{});
    statistics.arrays_seconds = seconds_since(start);
  }

  // Their memory is known before they are made.
  void choose_spheres(const PlanOptions& o, bool single_far) {
    for (FarField& f : problem.fields) {
      f.translations = rbf_for(f.translations, o.tolerance, single_far);
      sphere_bytes += rbf_bytes(f.translations, single_far ? sizeof(float) : sizeof(double));
    }
    if (sphere_bytes > o.max_bytes)
      throw InputError(fmt::format(
          "fast multipole method: the scheme rbf-sphere needs {} MiB for its translations, more than the {} MiB "
          "allowed; use the default scheme or raise the limit",
          sphere_bytes >> 20, o.max_bytes >> 20));
  }

  // Counted before it is taken, and remembered.
  void refuse_too_large(const PlanOptions& o, const ListCounts& counts, bool single_far, bool single_near) {
    const PairShape shape = pair_shape(problem.sum);
    const double far = single_far ? 4 : 8, near = single_near ? 4 : 8;
    double coefficients = 0;
    for (const FarField& f : problem.fields)
      coefficients += static_cast<double>(f.columns * translations(f.translations)->rank);
    const double boxes = static_cast<double>(tree->box_count()), ns = static_cast<double>(sources),
                 nt = static_cast<double>(targets);
    const double bytes = static_cast<double>(sphere_bytes) + 28 * (ns + nt) + 100 * boxes + 24 * counts.far_pairs +
                         ns * near * (3.0 + static_cast<double>(shape.strengths)) +
                         1.2 * nt * (near * 3 + (near + far) * static_cast<double>(shape.outputs)) +
                         2 * boxes * coefficients * far;
    statistics.bytes = static_cast<std::size_t>(bytes);
    if (bytes > static_cast<double>(o.max_bytes))
      throw InputError(fmt::format(
          "fast multipole method: {} sources and {} targets need {:.0f} MiB, more than the {} MiB allowed; use single "
          "precision, a coarser mesh or raise the limit",
          sources, targets, bytes / 1048576, o.max_bytes >> 20));
  }

  template <class Record>
  void apply(std::span<const double> strengths, std::span<double> out, std::size_t sets, const Record& record) const {
    const std::size_t own = first_normal(problem.sum), outputs = pair_shape(problem.sum).outputs;
    if (strengths.size() != sets * own * sources || out.size() != sets * outputs * targets)
      throw InputError(fmt::format("fast multipole method: {} strengths for {} x {} and {} outputs for {} x {}",
                                   strengths.size(), own, sources, out.size(), outputs, targets));
    for (std::size_t i = 0; i < strengths.size(); ++i)
      if (!std::isfinite(strengths[i]))
        throw InputError(
            fmt::format("fast multipole method: strength {} of source {} is not finite", i / sources, i % sources));
    std::visit(
        [&](const auto& e) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(e)>, std::monostate>) {
            auto state = e.start(strengths, out, sets, factor);
            schedule->graph().run([&](TaskGraph::Task t) { record(t, [&] { e.run(schedule->task(t), state); }); });
          }
        },
        evaluator);
  }
};

Plan::Plan(PairSum sum, const PairConstants<double>& constants, const Points& points, const PlanOptions& options)
    : impl_(std::make_unique<Impl>(sum, constants, points, options)) {}
Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;

std::size_t Plan::strengths() const {
  return first_normal(impl_->problem.sum);
}
std::size_t Plan::outputs() const {
  return pair_shape(impl_->problem.sum).outputs;
}
const TaskGraph& Plan::tasks() const {
  return impl_->schedule->graph();
}
const PlanStatistics& Plan::statistics() const {
  return impl_->statistics;
}

void Plan::apply(std::span<const double> strengths, std::span<double> out, std::size_t sets) const {
  impl_->apply(strengths, out, sets, [&](TaskGraph::Task t, const auto& body) {
    const TraceScope scope(task_name(impl_->schedule->task(t).kind));
    body();
  });
}

std::vector<TaskRecord> Plan::apply_traced(std::span<const double> strengths, std::span<double> out) const {
  const Schedule& schedule = *impl_->schedule;
  std::vector<TaskRecord> records(schedule.graph().size());
  const auto start = Clock::now();
  impl_->apply(strengths, out, 1, [&](TaskGraph::Task t, const auto& body) {
    const double begin = seconds_since(start);
    body();
    const Schedule::Task& task = schedule.task(t);
    const Chunk& chunk = schedule.chunks()[task.chunk];
    records[t] = {task_name(task.kind), chunk.end - chunk.begin, TaskGraph::worker(), begin, seconds_since(start)};
  });
  return records;
}

}  // namespace sherd::fmm
