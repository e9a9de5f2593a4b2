// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// Something of each role.
template <class T>
struct ByRole {
  std::array<T, all_roles.size()> values{};
  T& operator[](Role role) { return values[at(role)]; }
  const T& operator[](Role role) const { return values[at(role)]; }
};

/// The names of the columns of recorded rows, and of the series.
struct RowNames {
  RowNames() = default;
  explicit RowNames(const Simulation&);

  ByRole<std::vector<std::string>> of{{{std::vector<std::string>{"phi"}}}};  ///< names of the components
  std::vector<std::string> further;               ///< columns of series.csv after the residual
  std::vector<Simulation::DatasetInfo> datasets;  ///< what fields.h5 has beside the components
  struct Mesh {
    Role role;
    std::size_t index;
  };
  std::optional<Mesh> mesh;  ///< the component that is the position of the sites

  /// The names that figures draw: the fields, then the positions of sites that move, if these are not a field.
  std::vector<std::string> drawn() const;
  std::optional<std::size_t> drawn_mesh() const;  ///< which of them are the positions
  /// One field at the vertices, and nothing else.
  bool plain() const;
};

}  // namespace delf
