// SPDX-License-Identifier: MIT
#include "schemes/theories/field_theory.hpp"

#include <algorithm>

#include "jets/tables/named_tables.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/wall_families.hpp"

namespace delf {

std::shared_ptr<const StencilFamily> FieldTheory::variational(const std::string& stencil) const {
  const auto found = std::ranges::find(named_tables(), stencil, &NamedTable::name);
  return found == named_tables().end() ? nullptr : on_table(found->table);
}

std::vector<std::shared_ptr<const StencilFamily>> FieldTheory::at_walls(const std::string& stencil,
                                                                        const Lattice& lattice) const {
  const auto found = std::ranges::find(named_tables(), stencil, &NamedTable::name);
  if (found == named_tables().end()) return {};
  return wall_families(found->table, density_, lattice);
}

std::shared_ptr<const StencilFamily> FieldTheory::on_table(StencilTable table, bool values_are_sources) const {
  return std::make_shared<JetFamily>(std::move(table), density_, values_are_sources);
}

std::shared_ptr<const StencilFamily> FieldTheory::comparator(DirectResidual stencil) const {
  if (!density_->has_difference_quotient()) return nullptr;
  return std::make_shared<ResidualFamily>(std::move(stencil), density_);
}

}  // namespace delf
