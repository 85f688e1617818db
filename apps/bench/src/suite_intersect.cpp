#include <fmt/format.h>
#include <isolux/core/random.h>
#include <isolux/volume_io/analytic_fields.h>
#include <isolux/volume_io/read.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cell_intersectors.h"
#include "stats.h"
#include "suites.h"

namespace isolux::bench {
namespace {

struct ProblemSet {
  std::string id;
  std::string title;
  std::vector<CellProblem> problems;
};

/// A straight way through the unit cell: a random line through a random inner point.
void random_way(RandomStream& random, CellProblem& problem) {
  std::array<double, 3> point{};
  std::array<double, 3> step{};
  const double z = 2.0 * random.uniform_double() - 1.0;
  const double angle = 2.0 * std::numbers::pi * random.uniform_double();
  const double r = std::sqrt(1.0 - z * z);
  step = {r * std::cos(angle), r * std::sin(angle), z};
  double back = -1e9;
  double forth = 1e9;
  for (std::size_t a = 0; a < 3; ++a) {
    point[a] = random.uniform_double();
    if (step[a] == 0.0) continue;
    const double t0 = -point[a] / step[a];
    const double t1 = (1.0 - point[a]) / step[a];
    back = std::max(back, std::min(t0, t1));
    forth = std::min(forth, std::max(t0, t1));
  }
  for (std::size_t a = 0; a < 3; ++a) {
    problem.enter[a] = std::clamp(point[a] + back * step[a], 0.0, 1.0);
    problem.leave[a] = std::clamp(point[a] + forth * step[a], 0.0, 1.0);
  }
}

ProblemSet random_cells(std::size_t count, std::uint64_t seed) {
  ProblemSet set{.id = "random", .title = "random cells", .problems = std::vector<CellProblem>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, i, 11);
    for (double& v : set.problems[i].corners) v = double(float(2.0 * random.uniform_double() - 1.0));
    random_way(random, set.problems[i]);
  }
  return set;
}

/// Cells of a volume that the ray's isovalue, that of a random point of the volume, passes through.
ProblemSet volume_cells(const std::string& id, const Volume& volume, std::size_t count, std::uint64_t seed) {
  ProblemSet set{.id = id, .title = fmt::format("cells of {}", id), .problems = {}};
  const Index3 n = volume.lattice().size - 1;
  for (std::uint64_t i = 0; set.problems.size() < count && i < 200 * count; ++i) {
    RandomStream random(seed, i, 12);
    const auto pick = [&](int size) { return std::min(int(random.uniform_double() * size), size - 1); };
    const int x = pick(n.x);
    const int y = pick(n.y);
    const int z = pick(n.z);
    CellProblem problem;
    for (unsigned q = 0; q < 8; ++q) {
      problem.corners[q] = double(volume.values(x + int(q & 1u), y + int(q >> 1 & 1u), z + int(q >> 2)));
    }
    const auto [low, high] = std::minmax_element(problem.corners.begin(), problem.corners.end());
    if (*low == *high) continue;
    const double isovalue = double(float(*low + random.uniform_double() * (*high - *low)));
    for (double& v : problem.corners) v -= isovalue;
    random_way(random, problem);
    set.problems.push_back(problem);
  }
  return set;
}

/// A cell whose diagonal has the cubic with these Bernstein coefficients.
CellProblem diagonal(const std::array<double, 4>& b) {
  CellProblem problem{
      .corners = {b[0], b[1], b[1], b[2], b[1], b[2], b[2], b[3]}, .enter = {0, 0, 0}, .leave = {1, 1, 1}};
  return problem;
}

/// -(s - a)^2 (s - c) - gap, nearly a double root at a where gap is small, in Bernstein form.
std::array<double, 4> near_double(double a, double c, double gap) {
  const double c0 = a * a * c - gap;
  const double c1 = -(a * a + 2.0 * a * c);
  const double c2 = 2.0 * a + c;
  return {c0, c0 + c1 / 3.0, c0 + (2.0 * c1 + c2) / 3.0, c0 + c1 + c2 - 1.0};
}

/// Tangents, near-double roots, leading coefficients of 1e-20, values of 1e30 and 1e-30, 16 bits near their end.
ProblemSet adversarial(std::size_t count, std::uint64_t seed) {
  ProblemSet set{.id = "adversarial", .title = "adversarial cells", .problems = {}};
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(seed, i, 13);
    const double u = random.uniform_double();
    const double v = random.uniform_double();
    CellProblem problem;
    switch (i % 5) {
      case 0:
        problem = diagonal(
            near_double(u, 1.2 + v, std::pow(10.0, -3.0 - 10.0 * random.uniform_double()) * (v > 0.5 ? 1.0 : -1.0)));
        break;
      case 1: {
        // A straight line but for rounding: the cubic's and the quadratic's coefficients are 1e-20 of it.
        const double tiny = 1e-20 * (v - 0.5);
        problem = diagonal({-u, -u + 1.0 / 3.0 + tiny, -u + 2.0 / 3.0 - tiny, -u + 1.0});
        break;
      }
      case 2:
      case 3: {
        const double scale = i % 5 == 2 ? 1e30 : 1e-30;
        for (double& corner : problem.corners) corner = scale * (2.0 * random.uniform_double() - 1.0);
        random_way(random, problem);
        break;
      }
      default:
        // The isovalue is a float between whole numbers near 65535.
        for (double& corner : problem.corners)
          corner = 65535.0 - std::floor(3.0 * random.uniform_double()) - double(float(65533.0 + 2.0 * u));
        random_way(random, problem);
    }
    set.problems.push_back(problem);
  }
  return set;
}

struct Accuracy {
  double rms_error = 0.0;
  double largest_error = 0.0;
  double wrong = 0.0;      ///< per million decided: a hit where there is none, none where there is one, another root
  double undecided = 0.0;  ///< per million
};

Accuracy accuracy(const CellIntersector& intersector, const ProblemSet& set, const std::vector<CellVerdict>& verdicts) {
  std::vector<double> errors;
  double wrong = 0.0;
  double decided = 0.0;
  for (std::size_t i = 0; i < set.problems.size(); ++i) {
    if (!verdicts[i].decided) continue;
    decided += 1.0;
    const CellRoot root = intersector.first_root(set.problems[i]);
    if (root.has_value() != verdicts[i].root.has_value()) {
      wrong += 1.0;
    } else if (root) {
      const double error = std::fabs(*root - *verdicts[i].root);
      // More than a tenth of the cell away is another root, or none.
      if (!(error < 0.1)) {
        wrong += 1.0;
      } else {
        errors.push_back(error);
      }
    }
  }
  Accuracy result;
  result.rms_error = rms(errors);
  for (const double e : errors) result.largest_error = std::max(result.largest_error, e);
  result.wrong = 1e6 * wrong / std::max(1.0, decided);
  result.undecided = 1e6 * (1.0 - decided / double(set.problems.size()));
  return result;
}

Estimate nanoseconds(const CellIntersector& intersector, const ProblemSet& set, double seconds, double& sink) {
  Estimate t = timed(
      [&] {
        for (const CellProblem& problem : set.problems) sink += intersector.first_root(problem).value_or(0.0);
      },
      15, seconds);
  const double scale = 1e9 / double(set.problems.size());
  return {.value = t.value * scale, .low = t.low * scale, .high = t.high * scale};
}

std::vector<ProblemSet> problem_sets(const SuiteContext& context) {
  const auto count = std::size_t(context.pick(1000, 50000, 500000));
  std::vector<ProblemSet> sets;
  sets.push_back(random_cells(count, context.run.seed));
  sets.push_back(volume_cells("noise", sample_analytic_field("noise", 33, context.run), count, context.run.seed));
  if (!context.data_folder.empty()) {
    sets.push_back(volume_cells("engine", read_volume(context.data_folder + "/engine.nrrd"), count, context.run.seed));
  }
  sets.push_back(adversarial(count, context.run.seed));
  return sets;
}

/// The pictures of one set of cells and of wrong hits in all, and the table.
struct IntersectFigures {
  std::vector<Plot> errors;
  Plot wrong{.id = "wrong",
             .title = "Time of a ray-cell test against wrong hits",
             .x_label = "ns a test",
             .y_label = "wrong hits per million"};
  Table table{.id = "all",
              .title = "Wrong hits",
              .columns = {"cells", "intersector", "ns", "quartile", "quartile ", "wrong per million", "rms error",
                          "largest error", "undecided per million"}};
};

/// Adds what one intersector does with one set: a mark in each picture, a row of the table.
void measure(const CellIntersector& intersector, const ProblemSet& set, const std::vector<CellVerdict>& verdicts,
             const Estimate& ns, Series& error, Series& wrong, SuiteReport& report, Table& table) {
  const Accuracy found = accuracy(intersector, set, verdicts);
  table.rows.push_back({set.title, std::string(intersector.name), ns.value, ns.low, ns.high, found.wrong,
                        found.rms_error, found.largest_error, found.undecided});
  error.points.push_back({.x = ns.value, .y = found.rms_error, .left = ns.low, .right = ns.high});
  // A third of a hit for none: a logarithm has no zero.
  const double cells = double(set.problems.size());
  const double spread = 1e6 * std::sqrt(1e-6 * found.wrong * cells) / cells;
  wrong.points.push_back({.x = ns.value,
                          .y = std::max(found.wrong, 0.33e6 / cells),
                          .low = found.wrong > 0.0 ? found.wrong - spread : kNone,
                          .high = found.wrong > 0.0 ? found.wrong + spread : kNone});
  if (&intersector == &cell_intersectors().front() && found.wrong > 0.0)
    report.failures.push_back(fmt::format("{}: {:.3g} wrong hits per million", set.title, found.wrong));
}

/// "Of the others only X was without a wrong hit" or the like, from the table.
std::string errors_beside_others(const Table& table) {
  double ours = 0.0;
  double fewest = 1e30;
  std::string best;
  for (const CellIntersector& intersector : cell_intersectors()) {
    double most = 0.0;
    for (const auto& row : table.rows) {
      if (std::get<std::string>(row[1]) == intersector.name) most = std::max(most, std::get<double>(row[5]));
    }
    if (&intersector == &cell_intersectors().front()) {
      ours = most;
    } else if (most < fewest) {
      fewest = most;
      best = intersector.name;
    }
  }
  return fmt::format(
      "In the worst set of cells our intersector answers {} tests in a million wrongly, the best of the others ({}) "
      "{}.",
      number_text(ours), best, number_text(fewest));
}

}  // namespace

SuiteReport run_intersect(const SuiteContext& context) {
  SuiteReport report;
  const std::vector<ProblemSet> sets = problem_sets(context);
  IntersectFigures figures;
  figures.wrong.sentence =
      "A mark for each set of cells, with the deviation of the count; what made no wrong hit is drawn at a third of "
      "one "
      "hit.";
  figures.table.sentence =
      "Judged in long double precision; wrong are hits where there is none, misses, and roots more than a tenth of the "
      "way off. Undecided are cells whose answer turns on the last bits of double precision; they count for nobody.";
  for (const CellIntersector& intersector : cell_intersectors())
    figures.wrong.series.push_back({.name = std::string(intersector.name), .stroke = Stroke::kMarks});
  double sink = 0.0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const ProblemSet& set = sets[s];
    context.say(set.title);
    Plot plot{.id = "error-" + set.id,
              .title = fmt::format("Time of a ray-cell test against hit error: {}", set.title),
              .x_label = "ns a test",
              .y_label = "rms error of the hit, parts of the way through the cell"};
    plot.sentence = fmt::format(
        "One thread, {} cells; errors are of correct hits only, bars are quartiles of the time's repetitions.",
        set.problems.size());
    std::vector<CellVerdict> verdicts;
    for (const CellProblem& problem : set.problems) verdicts.push_back(cell_oracle(problem));
    for (std::size_t i = 0; i < cell_intersectors().size(); ++i) {
      const CellIntersector& intersector = cell_intersectors()[i];
      const double seconds = 0.5 * context.budget.share((sets.size() - s) * cell_intersectors().size() - i);
      const Estimate ns = nanoseconds(intersector, set, seconds, sink);
      plot.series.push_back({.name = std::string(intersector.name), .stroke = Stroke::kMarks});
      measure(intersector, set, verdicts, ns, plot.series.back(), figures.wrong.series[i], report, figures.table);
    }
    figures.errors.push_back(std::move(plot));
  }
  // Printed so that no compiler drops the timed work.
  context.say(fmt::format("sum of all roots {:.6g}", sink));
  report.highlights.push_back(errors_beside_others(figures.table));
  for (Plot& plot : figures.errors) report.figures.emplace_back(std::move(plot));
  report.figures.emplace_back(std::move(figures.wrong));
  report.figures.emplace_back(std::move(figures.table));
  return report;
}

}  // namespace isolux::bench
