// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "jets/force_squared.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "jets/tables/suited_pairs.hpp"
#include "lattice/error.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/methods/kernel_alone.hpp"
#include "schemes/methods/pair_parts.hpp"
#include "schemes/stability/splitting_limit.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

constexpr int usual_gradient_order = 6;

/// κ = g h²/M, where ℓ has ½M φ_t² for every field and nothing else that is quadratic in rates.
double gradient_scale(const BatchDensity& density, double gradient, double h) {
  const int d = density.components(), m = density.variables();
  const auto rates = [&](int a, int b) { return density.constant_hessian()[(d + a) * m + d + b]; };
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      if (rates(a, b) != (a == b ? rates(0, 0) : 0) || rates(a, a) == 0)
        throw BadInput("theory.name",
                       "theory.name: a force gradient takes densities with the same 0.5*M*phi_t^2 for every "
                       "field; use scheme.kernel = b6");
  return gradient * h * h / rates(0, 0);
}

struct Chosen {
  Splitting splitting;
  std::vector<double> pairs;
  int gradient_pairs = 0;
};

Chosen chosen(const Problem& p) {
  const std::string kernel = p.parameters.get<std::string>("scheme.kernel");
  Chosen c{processed_splitting(kernel), {}};
  const int order = p.parameters.get<int>("lattice.space_order"),
            pairs = pairs_of_order(p, "lattice.space_order", order);
  const double rho = p.parameters.get<double>("lattice.analyticity");
  c.pairs = p.parameters.get<std::string>("lattice.pairs") == "suited"
                ? suited_pairs(pairs, rho / p.lattice.space_step())
                : pair_weights(pairs);
  if (c.splitting.gradient != 0)
    c.gradient_pairs = pairs_of_order(
        p, "lattice.gradient_order",
        p.parameters.maybe<int>("lattice.gradient_order").value_or(std::min(order, usual_gradient_order)));
  if (c.gradient_pairs > pairs)
    throw BadInput("lattice.gradient_order",
                   fmt::format("lattice.gradient_order = {}: above lattice.space_order = {}; lower it",
                               2 * c.gradient_pairs, order));
  return c;
}

bool has_processor(const Problem& p) { return p.parameters.maybe<std::string>(processor_key).value_or("on") == "on"; }

SchemeParts processed_parts(const FieldTheory& theory, const Problem& p) {
  Chosen c = chosen(p);
  if (!has_processor(p)) c.splitting.processor = {};
  SchemeParts parts = pair_parts(theory, p, c.splitting, c.pairs);
  if (c.gradient_pairs > 0) {
    const auto squares = std::make_shared<ForceSquared>(
        theory.shared_density(), gradient_scale(theory.density(), c.splitting.gradient, p.time_step));
    const StencilTable table = force_table(c.gradient_pairs, c.splitting.offset);
    parts.families.insert(parts.families.begin() + 1, std::make_shared<JetFamily>(table, squares));
    for (StencilTable& at_wall : at_both_walls(table, p.lattice))
      parts.families.push_back(std::make_shared<JetFamily>(std::move(at_wall), squares));
  }
  const double k = p.lattice.space_step(), decay = p.parameters.get<double>("lattice.analyticity") / k;
  const std::vector<double> force = c.gradient_pairs > 0 ? pair_weights(c.gradient_pairs) : c.pairs;
  parts.remarks = {has_processor(p) ? "rows         of a kernel; residuals and the form formula are theirs. Recorded "
                                      "rows have the processor undone"
                                    : "rows         of a kernel alone, without its processor: of lower order",
                   fmt::format("pairs        weights {:.10g}", fmt::join(c.pairs, ", ")),
                   fmt::format("dispersion   max |S(θ) − θ²| e^(−ρθ/k)/θ = {:.3g}, ρ = {:g}",
                               weighted_defect(c.pairs, decay), decay * k),
                   fmt::format("limits       ωh < {:.4g}; without a mass h/k < {:.4g}", frequency_limit(c.splitting),
                               courant_limit(c.splitting, c.pairs, force))};
  return parts;
}

std::string name_of(const Problem& p) {
  return fmt::format("processed ({},{}){}", p.parameters.get<std::string>("scheme.kernel"),
                     p.parameters.get<int>("lattice.space_order"),
                     p.parameters.get<std::string>("lattice.pairs") == "suited" ? " suited" : "") +
         (has_processor(p) ? "" : ", kernel alone");
}

std::vector<NamedScheme> processed_variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (const char* pairs : {"maximal", "suited"})
    for (const char* kernel : {"ti4", "b6"})
      for (int space = 6; space <= 2 * widest_pair; space += 2) {
        if (kernel == std::string("ti4") && space > 14) continue;
        Problem problem = base;
        problem.parameters["scheme.kernel"] = std::string(kernel);
        problem.parameters["lattice.space_order"] = space;
        problem.parameters["lattice.pairs"] = std::string(pairs);
        schemes.push_back({name_of(problem), problem});
        schemes.back().tuned = pairs == std::string("suited");
      }
  return schemes;
}

/// The lower one of the orders of kernel and pairs; pairs suited to a solution have an order at a finer k only.
std::optional<int> processed_order(const Problem& p) {
  if (p.parameters.get<std::string>("lattice.pairs") == "suited" || !has_processor(p)) return std::nullopt;
  const int time = p.parameters.get<std::string>("scheme.kernel") == "ti4" ? 4 : 6;
  return std::min(time, p.parameters.get<int>("lattice.space_order"));
}

std::string processed_words(const Problem& p) {
  const bool suited = p.parameters.get<std::string>("lattice.pairs") == "suited";
  const int reach = p.parameters.get<int>("lattice.space_order");
  return fmt::format(
      "the explicit symplectic kernel {}{} in time with central differences {} in space",
      p.parameters.get<std::string>("scheme.kernel"),
      has_processor(p) ? ", corrected by its processor," : " without its processor",
      suited ? fmt::format("over {} sites fitted to analytic fields", reach + 1) : fmt::format("of order {}", reach));
}

}  // namespace

extern const MethodEntry processed_method;
const MethodEntry processed_method{
    .name = "processed",
    .formula = "kernels of effective order 4 and 6 over wide pairs, processed where rows are recorded: explicit",
    .build = processed_parts,
    .parameters = {{.key = "lattice.analyticity",
                    .fallback = 2.2,
                    .help = "half-width of the strip in which the field is analytic, for suited pairs",
                    .unit = "length",
                    .range = {.low = 0},
                    .without = {{"lattice.pairs", {"maximal"}}}},
                   {.key = "lattice.gradient_order",
                    .fallback = usual_gradient_order,
                    .help = "order in space of the force that the kick of ti4 has the gradient of",
                    .range = {.low = 2, .high = 2 * widest_pair},
                    .otherwise = "6, or lattice.space_order if that is less",
                    .without = {{"scheme.kernel", {"b6"}}}},
                   {.key = "lattice.pairs",
                    .fallback = std::string("maximal"),
                    .help = "weights of pairs: of maximal order, or suited to lattice.analyticity",
                    .choices = {"maximal", "suited"}},
                   space_order_parameter(),
                   {.key = "scheme.kernel",
                    .fallback = std::string("b6"),
                    .help = "ti4: one kick a step, with a force gradient; b6: six kicks",
                    .choices = {"ti4", "b6"}},
                   {.key = processor_key,
                    .fallback = std::string("on"),
                    .help = "off: rows of the kernel alone, which verify --fields takes; of lower order",
                    .choices = {"on", "off"}}},
    .label = name_of,
    .starts = {StartRule::legendre},
    .start = StartRule::legendre,
    .variants = processed_variants,
    .order = processed_order,
    .words = processed_words,
    .sources = {"blanes-casas-ros-1999", "fornberg-1988"},
    .further_sources = [](const Problem& p) -> std::vector<std::string> {
      // b6 and both processors were found for delf
      return {p.parameters.get<std::string>("scheme.kernel") == "ti4" ? "takahashi-imada-1984" : "delf"};
    }};

}  // namespace delf
