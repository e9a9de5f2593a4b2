// SPDX-License-Identifier: MIT
#pragma once
#include <tuple>

#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"
#include "schemes/theories/double_sine_gordon.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/sine_gordon_impurity.hpp"
#include "schemes/theories/wave.hpp"

/// Every theory and every jet map, for the tests of this folder.
namespace delf::testing {

inline const std::tuple all_theories{Wave{},       KleinGordon{1.3},           SineGordon{1.2},
                                     PhiFour{0.7}, DoubleSineGordon{1.1, 0.4}, SineGordonImpurity{1.1, 0.6, 0.8, 0.3}};
inline constexpr std::tuple all_maps{triangle, triangle_vertex, rectangle, rectangle_symmetric,
                                     hexagon,  six_tuple,       nine_tuple};

template <class Function>
void for_each_theory(Function&& f) {
  std::apply([&](const auto&... theory) { (f(theory), ...); }, all_theories);
}
template <class Function>
void for_each_map(Function&& f) {
  std::apply([&](const auto&... map) { (f(map), ...); }, all_maps);
}

}  // namespace delf::testing
