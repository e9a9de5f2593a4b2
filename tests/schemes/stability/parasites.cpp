// SPDX-License-Identifier: MIT
#include "schemes/stability/parasites.hpp"

#include <memory>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "jets/expressions/expression.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"
#include "schemes/scheme.hpp"

namespace delf {
namespace {

template <class Map>
std::vector<std::string> waves(Map, const char* density) {
  const LatticeSystem system(Lattice::circle(16, 16.0),
                             {std::make_shared<JetFamily>(stencil_table(Map::table), expression(density))}, 0.25);
  std::vector<std::string> names;
  for (const Parasite& parasite : parasites(Symbol(system))) names.push_back(parasite.wave);
  return names;
}

}  // namespace

TEST_CASE("waves that no field equation has are named, and only they") {
  using Names = std::vector<std::string>;
  const char* wave = "0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2";
  CHECK(waves(triangle_vertex, wave).empty());
  CHECK(waves(rectangle, wave).empty());
  CHECK(waves(rectangle_symmetric, wave) == Names{"(-1)^(i+j)"});
  CHECK(waves(six_tuple, "0.5*phi_t^2 - 0.5*phi_xx^2").empty());
  // three rows for an equation of first order in t
  const char* kdv = "0.5*phi_x*phi_t - 0.5*phi_xx^2";
  CHECK(waves(six_tuple, kdv).front() == "(-1)^j");
  CHECK(waves(nine_tuple, kdv).front() == "(-1)^j");
}

}  // namespace delf
