// SPDX-License-Identifier: MIT
#include "schemes/methods/element_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "schemes/families/mesh_families.hpp"
#include "schemes/families/trace_stencil.hpp"
#include "schemes/problem.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

/// λ_n·(r⁺x_n − q_n) and μ_{n+1}·(r⁻x_n − q_{n+1}), with r⁺ = φ(0) and r⁻ = φ(1), at each node in space.
void add_traces(SchemeParts& parts, const std::vector<Component>& fields, const Traces& traces) {
  const std::vector<NodePosition>& nodes = traces.space.nodes;
  const int d = static_cast<int>(fields.size()), all = d * static_cast<int>(nodes.size());
  for (const auto& [end, name, weights] : {std::tuple{TraceStencil::End::lower, "lambda", &traces.lower},
                                           std::tuple{TraceStencil::End::upper, "mu", &traces.upper}}) {
    const int multiplier = static_cast<int>(parts.components.size());
    for (const bool inside : {false, true}) {
      std::vector<std::pair<int, int>> tied;
      for (int a = inside ? d : 0; a < (inside ? all : d); ++a) tied.push_back({a, multiplier + a});
      if (!tied.empty())
        parts.families.push_back(
            std::make_shared<LagrangianFamily<TraceStencil>>(TraceStencil(end, all, *weights, tied, d, inside)));
    }
    for (const NodePosition& node : nodes)
      for (const Component& field : fields)
        parts.components.push_back({node.space == 0 ? fmt::format("{} of {}", name, field.name)
                                                    : fmt::format("{} of {} at {:.4g}", name, field.name, node.space),
                                    Role::multiplier, node, false, field.field, true});
  }
}

}  // namespace

SchemeParts element_parts(const FieldTheory& theory, const StencilTable& element, const std::optional<Traces>& traces) {
  SchemeParts parts{{theory.on_table(element)}, theory.fields(), theory.symmetries()};
  const bool point = std::ranges::all_of(element.pattern.vertices, [](const Site& v) { return v.space == 0; });
  const std::size_t traced = traces ? traces->space.nodes.size() : 0;
  for (std::size_t node = 1; node < element.nodes.size(); ++node)
    for (const Component& field : theory.fields()) {
      const NodePosition at = element.nodes[node];
      parts.components.push_back({point ? fmt::format("{} at {:.4g}", field.name, at.time)
                                        : fmt::format("{} at ({:.4g}, {:.4g})", field.name, at.time, at.space),
                                  node < traced ? Role::trace : Role::inner, at, false, field.field});
    }
  if (traces) add_traces(parts, theory.fields(), *traces);
  return parts;
}

void take_to_mesh(SchemeParts& parts, const FieldTheory& theory, const Problem& p, const StencilTable& time,
                  bool values_are_sources) {
  if (!p.lattice.mesh()) return;
  const auto families = mesh_families(time, theory.shared_density(), *p.lattice.mesh(), values_are_sources);
  parts.families.erase(parts.families.begin());
  parts.families.insert(parts.families.begin(), families.begin(), families.end());
}

std::vector<double> row_rates(const RowsInTime& rows, std::span<const double> momenta) {
  const auto v = LegendreTransform(rows.system, rows.rows, rows.newest).velocities(momenta);
  return v ? *v : std::vector(momenta.size(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace delf
