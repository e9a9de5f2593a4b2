// SPDX-License-Identifier: MIT
#include "tools/scene/keys.hpp"

#include <algorithm>
#include <array>

#include "schemes/nearest_name.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/stability/stability_request.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

namespace {

using Names = std::vector<std::string>;

template <class Infos>
Names names_of(const Infos& infos) {
  Names names;
  for (const auto& info : infos) names.push_back(info.name);
  return names;
}

Names theory_names() { return names_of(theories()); }
Names stencil_names() { return names_of(stencils()); }
Names method_names() { return names_of(methods()); }
Names state_names() {
  Names names = names_of(states());
  if (std::find(names.begin(), names.end(), "file") == names.end()) names.push_back("file");
  return names;
}
Names fibres() { return {"R", "S1"}; }
Names spaces() { return {"circle", "interval", "point"}; }
Names walls() { return {"fixed", "natural"}; }
Names quadratures() { return {"gauss", "lobatto"}; }
Names faults() { return verify_faults(); }
Names stability_fault_names() { return stability_faults(); }
Names starts() { return {"exact", "centred", "legendre"}; }

constexpr double largest_int = std::numeric_limits<int>::max();
constexpr double largest_count = 9007199254740992;  // 2⁵³: every integer below it is a double
constexpr Limits any{};
constexpr Limits positive{0, any.high, true};
constexpr Limits not_negative{0, any.high};
constexpr Limits count{0, largest_count};
constexpr Limits whole{-largest_int, largest_int};
constexpr Limits from_zero{0, largest_int};
constexpr Limits one_or_more{1, largest_int};
constexpr Limits two_or_more{2, largest_int};
constexpr Limits up_to_eight{0, 8};
constexpr Limits degrees{1, 12};
constexpr Limits orders_in_time{2, 8};
constexpr Limits orders_in_space{2, 12};
constexpr Limits threads{1, 1024};
constexpr auto own = "the state's own";
constexpr auto real = KeyType::real;
constexpr auto integer = KeyType::integer;
constexpr auto choice = KeyType::choice;
constexpr auto toggle = KeyType::toggle;

const std::array table{
    Key{"theory.name", choice, "sine-gordon", "", "the field theory; see `delf list theories`", "", any, theory_names},
    Key{"theory.fibre", choice, "R", "", "where the field has its values: the line, or the circle of angles", "", any,
        fibres},
    Key{"theory.mass", real, "1", "", "m, where a theory has one", "1/length", not_negative},
    Key{"theory.lambda", real, "1", "", "the second coupling, where a theory has one"},
    Key{"theory.strength", real, "1", "", "strength of the impurity"},
    Key{"theory.width", real, "1", "", "width of the impurity", "length", positive},
    Key{"theory.position", real, "0", "", "position of the impurity", "length"},

    Key{"lattice.stencil", choice, "rectangle-symmetric", "", "stencil and jet; see `delf list stencils`", "", any,
        stencil_names},
    Key{"lattice.space", choice, "circle", "", "the shape of space", "", any, spaces},
    Key{"lattice.length", real, "", "must be given, but for a point", "L", "length", positive},
    Key{"lattice.sites", integer, "", "must be given, but for a point", "N; on an interval both walls are counted", "",
        two_or_more},
    Key{"lattice.space_order", integer, "4", "", "method = composition: order in space: 2, 4, ..., 12", "",
        orders_in_space},
    Key{"lattice.courant", real, "", "this or lattice.time_step", "h/k", "", positive},
    Key{"lattice.time_step", real, "", "this or lattice.courant", "h", "time", positive},

    Key{"scheme.method", choice, "multisymplectic", "", "the scheme; see `delf list schemes`", "", any, method_names},
    Key{"scheme.tolerance", real, "1e-14", "",
        "an implicit step ends when its next change is below this times what the field spans", "", positive},
    Key{"scheme.seed_order", integer, "8", "", "rows that the first guess of an implicit step is extrapolated from", "",
        up_to_eight},
    Key{"scheme.max_iterations", integer, "50", "", "iterations of an implicit step before it has failed", "",
        one_or_more},
    Key{"scheme.degree_time", integer, "2", "", "method = spacetime: degree of an element in time", "", degrees},
    Key{"scheme.degree_space", integer, "2", "", "method = spacetime: degree of an element in space", "", degrees},
    Key{"scheme.quadrature", choice, "gauss", "", "method = spacetime: the quadrature in time", "", any, quadratures},
    Key{"scheme.order", integer, "4", "", "method = composition: order in time: 2, 4, 6, 8", "", orders_in_time},
    Key{"scheme.alpha", real, "1", "", "method = r-adaptive: how much the mesh follows the field", "", positive},

    Key{"initial.state", choice, "", "must be given", "the state to start from; see `delf list states`", "", any,
        state_names},
    Key{"initial.position", real, "", own, "centre of the pulse, or of the pair", "length"},
    Key{"initial.speed", real, "", own, "v, |v| < 1", "length/time"},
    Key{"initial.separation", real, "", own, "distance between the two pulses of a pair", "length"},
    Key{"initial.frequency", real, "", own, "frequency of a breather", "1/time"},
    Key{"initial.wavenumber", real, "", own, "how many waves go into L"},
    Key{"initial.amplitude", real, "", own, "size of a wave, or of the noise"},
    Key{"initial.epsilon", real, "", own, "1 - the modulus of the elliptic functions"},
    Key{"initial.width", real, "", own, "width of a pulse", "length", positive},
    Key{"initial.eccentricity", real, "", own, "eccentricity of an orbit"},
    Key{"initial.file", KeyType::text, "", "none",
        "state = file: a fields.h5, or a .csv of row,site,values; looked for beside the scene first"},
    Key{"initial.frame", integer, "0", "", "state = file: the frame that row 0 is; the next frames are the next rows",
        "", from_zero},
    Key{"initial.start", choice, "",
        "legendre for method = spacetime; else exact where the second row is known, or centred", "what gives row 1", "",
        any, starts},

    Key{"boundary.left", choice, "fixed", "", "the left wall of an interval", "", any, walls},
    Key{"boundary.right", choice, "fixed", "", "the right wall of an interval", "", any, walls},
    Key{"boundary.winding", integer, "", own, "what the field gains around a circle, in units of 2 pi", "", whole},

    Key{"run.until", real, "", "this or run.steps", "time of the last row, rounded to whole steps", "time",
        not_negative},
    Key{"run.steps", integer, "", "this or run.until", "steps after row 0", "", count},
    Key{"run.seed", integer, "1", "", "seed of whatever is random", "", count},
    Key{"run.threads", integer, "1", "",
        "threads that long rows of explicit schemes are shared by; the bits are the same for any number", "", threads},

    Key{"output.every", integer, "", "about 400 records",
        "record rows 0, every, 2 every, ... and the last; 0: the last", "", count},
    Key{"output.figures", toggle, "on", "", "draw figures (by gnuplot)"},
    Key{"output.fields", toggle, "on", "", "write the recorded rows to fields.h5"},
    Key{"output.times", KeyType::times, "", "six, evenly spread", "times of the waveforms figure: 0, 10, 20", "time",
        not_negative},

    Key{"verify.regions", KeyType::text, "", "rectangle staircase hole wall slab random",
        "kinds of regions, drawn from run.seed; or ROWSxSITES, such as 0:8x10:30-3:5x18:22, rows from each moment's "
        "first"},
    Key{"verify.variations", integer, "2", "", "pairs of first variations V, W of either sort for each region", "",
        one_or_more},
    Key{"verify.moments", integer, "8", "", "moments of the run, evenly spread, at which regions are drawn", "",
        one_or_more},
    Key{"verify.tolerance", real, "1e-13", "", "a sum that ought to be zero may be this, relative to its terms", "",
        positive},
    Key{"verify.checks", KeyType::text, "", "all that apply",
        "some of equations, forms, noether, balance, reversal, derivatives, newton"},
    Key{"verify.generator", KeyType::text, "", "none",
        "a symmetry to try, as the change of each field: 1, or -phi2, phi1"},
    Key{"verify.force", toggle, "off", "", "take Noether's sums even for what is found to be no symmetry"},
    Key{"verify.fault", choice, "none", "",
        "plants a fault that must be found: variation, sign (of one derivative of L) or field (at one site)", "", any,
        faults},

    Key{"stability.schemes", KeyType::text, "", "eight, one of each sort", "schemes, separated by commas, or all"},
    Key{"stability.mass_steps", KeyType::text, "", "0.5, 1, 2.3", "values of mh at which limits are found"},
    Key{"stability.most_courant", real, "3", "", "Courant numbers are looked at up to this", "", positive},
    Key{"stability.steps", integer, "2000", "", "steps of a run from noise", "", Limits{100, 1e7}},
    Key{"stability.agreement", real, "0.01", "", "theory and runs may differ by this, relative", "", positive},
    Key{"stability.corners", KeyType::text, "", "all",
        "some of stiff, courant, fast-kink, amplitude, size, long, second-term, wave-map, resonance, angle; or none"},
    Key{"stability.budget", real, "1", "", "seconds for a corner before it is cut", "seconds", positive},
    Key{"stability.map", toggle, "on", "", "the map of Courant number and mh"},
    Key{"stability.fault", choice, "none", "", "plants a fault that must be found: limit", "", any,
        stability_fault_names},

    Key{"workprecision.schemes", KeyType::text, "", "all",
        "names of schemes, of methods or of peers, separated by commas; peers: all of those"},
    Key{"workprecision.sites", KeyType::text, "", "chosen, as far as the budget goes", "the ladder: N, N, ..."},
    Key{"workprecision.courants", KeyType::text, "", "chosen; with workprecision.sites the scene's own",
        "h/k, h/k, ..."},
    Key{"workprecision.accuracies", KeyType::text, "", "1e-2, 1e-3, ..., 1e-10", "errors whose cost is asked for"},
    Key{"workprecision.repeats", integer, "5", "", "how often each run is timed", "", one_or_more},
    Key{"workprecision.budget", real, "300", "", "what all of it may take, nearly", "seconds", positive},
    Key{"workprecision.peers", toggle, "on", "",
        "other programs in the same run, where they have the scene's equation"},
};

}  // namespace

std::span<const Key> keys() { return table; }

const Key* find_key(std::string_view name) {
  const auto key = std::find_if(table.begin(), table.end(), [&](const Key& k) { return k.name == name; });
  return key == table.end() ? nullptr : &*key;
}

std::string nearest_key(std::string_view unknown) {
  // without its section, or with a wrong one, a key is known by its last part: --sites, lattice.position
  const auto last = [](std::string_view name) { return name.substr(name.rfind('.') + 1); };
  Names full, same_last;
  for (const Key& key : table) {
    full.emplace_back(key.name);
    if (last(key.name) == last(unknown)) same_last.emplace_back(key.name);
  }
  if (const auto close = nearest(unknown, full)) return *close;
  if (!same_last.empty()) return same_last.front();
  Names lasts;
  for (const Key& key : table) lasts.emplace_back(last(key.name));
  const auto close = nearest(last(unknown), lasts);
  const auto at = close ? std::find(lasts.begin(), lasts.end(), *close) : lasts.end();
  return at == lasts.end() ? std::string() : full[static_cast<std::size_t>(at - lasts.begin())];
}

}  // namespace delf
