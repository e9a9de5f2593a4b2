// SPDX-License-Identifier: MIT
#include "jets/tables/named_splittings.hpp"

#include <cmath>

namespace delf {
namespace {

/// Drifts a_1 … a_n with kicks b_1 … b_{n−1} between them, none at the ends; each list mirrored at its end, or at its last
/// weight, from what is given of it.
Splitting drifts_first(std::vector<double> a, bool a_at_last, std::vector<double> b, bool b_at_last) {
  const auto mirror = [](std::vector<double>& half, bool at_last) {
    const std::vector<double> given = half;
    half.insert(half.end(), given.rbegin() + (at_last ? 1 : 0), given.rend());
  };
  mirror(a, a_at_last), mirror(b, b_at_last);
  b.insert(b.begin(), 0.0), b.push_back(0.0);
  return {std::move(b), std::move(a)};
}

/// R. I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151, symmetric, four kicks for q″ = f(q) ("SB3A").
Splitting mclachlan_4() {
  const double z = std::sqrt(7. / 8) / 3;
  return drifts_first({0.5 - z, z - 1. / 3, 2. / 3}, true, {1, -0.5}, false);
}
/// D. I. Okunbor, R. D. Skeel, J. Comput. Appl. Math. 51 (1994) 375, method 13, with the digits of McLachlan (1995).
Splitting okunbor_skeel_6() {
  return drifts_first(
      {-1.0130879789171747298, 1.1874295737325427070, -0.018335852096460590340, 0.34399425728109261313}, false,
      {0.00016600692650009894, -0.37962421426377360608, 0.68913741185181063674, 0.38064159097092574080}, true);
}
/// S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313, Table 3, "SRKN a" of 14 kicks.
Splitting blanes_moan_6a() {
  return drifts_first({0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
                       -0.130144459517415, 0.106417700369543, -0.00879424312851058, 0.2073050690568954},
                      true,
                      {0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
                       0.143761127168358, 0.328567693746804, -0.19641146648645423},
                      false);
}

}  // namespace

const std::vector<NamedSplitting>& named_splittings() {
  static const std::vector<NamedSplitting> list{
      {"leapfrog", 2, 1, [] { return splitting_of_order(2); }, {"verlet-1967", "hairer-lubich-wanner-2003"}},
      {"mclachlan-4", 4, 4, mclachlan_4, {"mclachlan-1995"}},
      {"blanes-moan-4", 4, 6, [] { return splitting_of_order(4); }, {"blanes-moan-2002"}},
      {"okunbor-skeel-6", 6, 7, okunbor_skeel_6, {"okunbor-skeel-1994", "mclachlan-1995"}},
      {"blanes-moan-6", 6, 11, [] { return splitting_of_order(6); }, {"blanes-moan-2002"}},
      {"blanes-moan-6a", 6, 14, blanes_moan_6a, {"blanes-moan-2002"}},
      {"kahan-li-8", 8, 17, [] { return splitting_of_order(8); }, {"kahan-li-1997"}}};
  return list;
}

}  // namespace delf
