// SPDX-License-Identifier: MIT
#include "jets/simd/pack_gather.hpp"

#include <algorithm>
#include <array>

#include "lattice/index.hpp"
#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("packs are gathered from places of any order, and scattered to them") {
  constexpr int size = 3 * lanes;
  std::array<double, size> from{}, to{};
  std::array<int, at(lanes)> places{};
  for (int i = 0; i < size; ++i) from[i] = 100 + i;
  for (int l = 0; l < lanes; ++l) places[l] = (5 * l + 2) % size;
  const Pack gathered = gather(from.data(), places.data());
  scatter(gathered + 1000.0, to.data(), places.data());
  for (int i = 0; i < size; ++i) {
    const auto lane = std::ranges::find(places, i) - places.begin();
    CAPTURE(i, lane);
    if (lane < lanes) CHECK(gathered[static_cast<int>(lane)] == 100 + i);
    CHECK(to[i] == (lane < lanes ? 1100 + i : 0));
  }
}

TEST_CASE("of lanes that are scattered to one place the last stays there") {
  std::array<double, 3> to{};
  std::array<int, at(lanes)> places{};
  places.fill(1);
  Pack numbers;
  for (int l = 0; l < lanes; ++l) numbers.v[l] = l + 1;
  scatter(numbers, to.data(), places.data());
  CHECK(to == std::array<double, 3>{0, lanes, 0});
}

TEST_CASE("lanes are added to places that others add to, as many as are asked for") {
  std::array<double, 3> to{1, 1, 1};
  std::array<int, at(lanes)> places{};
  places.fill(1);
  scatter_add(Pack(2.0), to.data(), places.data(), lanes);
  CHECK(to == std::array<double, 3>{1, 1 + 2 * lanes, 1});
  scatter_add(Pack(2.0), to.data(), places.data(), 1);
  CHECK(to == std::array<double, 3>{1, 3 + 2 * lanes, 1});
}
