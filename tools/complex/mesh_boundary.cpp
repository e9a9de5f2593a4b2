// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_boundary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/complex/cell_space.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "tools/scene/keys.hpp"

namespace delf {
namespace {

constexpr std::string_view of_boundary = "boundary.", by_part = "part.", of_flux = ".flux", periodic = "periodic:";

bool has_part(const Mesh& mesh, std::string_view name) {
  return std::ranges::any_of(mesh.parts, [&](const Mesh::Part& part) { return part.name == name; });
}

/// The part that a key names, and whether it is its flux.
struct NamedPart {
  std::string part;
  bool is_flux = false;

  NamedPart(const Mesh& mesh, std::string_view key) : part(key.substr(of_boundary.size())) {
    if (!has_part(mesh, part) && part.starts_with(by_part)) part = part.substr(by_part.size());
    if (has_part(mesh, part) || !part.ends_with(of_flux)) return;
    part.resize(part.size() - of_flux.size());
    is_flux = true;
  }
};

/// A word that is no formula: letters alone, and not the name of a number.
bool is_word(const std::string& text, const std::vector<std::pair<std::string, double>>& numbers) {
  return text.size() > 1 && text != "pi" && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos &&
         std::ranges::find(numbers, text, &std::pair<std::string, double>::first) == numbers.end();
}

}  // namespace

/// Formulas for a part, one for each field, and their derivatives by t.
struct MeshBoundary::Data {
  std::string key, text, part;
  std::vector<PlaceFormula> values, rates;

  Data(const Settings& settings, const std::string& key_, const std::string& text_, const std::string& part_,
       const std::vector<std::string>& fields, const std::vector<std::pair<std::string, double>>& numbers)
      : key(key_), text(text_), part(part_) {
    for (const std::string& formula : parts_of(text, ';')) {
      values.emplace_back(formula, numbers, key);
      rates.push_back(values.back().by(0));
    }
    if (values.size() != fields.size())
      throw settings.error(key,
                           fmt::format("gives {} formula{}, and the fields are {}; give one for each, separated by "
                                       "semicolons",
                                       values.size(), values.size() == 1 ? "" : "s", fmt::join(fields, ", ")));
  }
  bool reads_time() const {
    return std::ranges::any_of(values, [](const PlaceFormula& f) { return f.reads_time(); });
  }
};

/// The numbers at one point: those of formulas, each with a weight.
class MeshBoundary::AtPlace final : public GivenInTime {
 public:
  AtPlace(const Mesh& mesh, std::int32_t point) : place_(mesh.points[at(point)]) {}
  void add(std::shared_ptr<const Data> data, double weight) { terms_.emplace_back(std::move(data), weight); }

  double value(int field, double t) const override {
    double sum = 0;
    for (const auto& [data, weight] : terms_) sum += weight * finite(*data, data->values[at(field)](t, place_), t);
    return sum;
  }
  double rate(int field, double t) const override {
    double sum = 0;
    for (const auto& [data, weight] : terms_) sum += weight * finite(*data, data->rates[at(field)](t, place_), t);
    return sum;
  }

 private:
  double finite(const Data& data, double number, double t) const {
    if (std::isfinite(number)) return number;
    throw BadInput(data.key,
                   fmt::format("{} = {}: has no finite value or rate at t = {:.6g}, ({:.6g}); write it so that it "
                               "has one on the whole part",
                               data.key, data.text, t, fmt::join(place_, ", ")));
  }

  Mesh::Point place_;
  std::vector<std::pair<std::shared_ptr<const Data>, double>> terms_;
};

MeshBoundary::MeshBoundary(const Settings& settings, const Mesh& mesh, bool otherwise_fixed,
                           const std::vector<std::string>& fields,
                           const std::vector<std::pair<std::string, double>>& numbers)
    : otherwise_fixed_(otherwise_fixed) {
  std::map<std::string, std::string> held;  // the key of a part whose value is kept, or given
  std::map<std::string, std::string> keys;  // of all parts with a condition of their own
  for (const Setting& s : settings.all()) {
    if (!s.key.starts_with(of_boundary) || s.key == "boundary.mesh") continue;
    if (&s != settings.find(s.key)) continue;  // the command line wins
    const NamedPart named(mesh, s.key);
    const std::string& part = named.part;
    const bool is_flux = named.is_flux;
    if (!has_part(mesh, part)) {
      std::vector<std::string> names;
      for (const Mesh::Part& one : mesh.parts) names.push_back(one.name);
      throw settings.error(
          s.key,
          mesh.parts.empty() ? "the boundary of this mesh has no named parts; use boundary.mesh"
          : part == "mesh"
              ? fmt::format("boundary.mesh is fixed or natural, and no part; something flows in by boundary.NAME.flux, "
                            "at the parts {}",
                            fmt::join(names, ", "))
              : fmt::format("the mesh has no part of this name; its parts are {}", fmt::join(names, ", ")));
    }
    const auto data = [&] { return std::make_shared<const Data>(settings, s.key, s.value, part, fields, numbers); };
    if (const auto [known, fresh] = keys.try_emplace(is_flux ? part + std::string(of_flux) : part, s.key); !fresh)
      throw settings.error(s.key, fmt::format("is the part that {} names too; leave one of them out", known->second));
    if (is_flux) {
      fluxes_.push_back(data());
    } else {
      if (s.value == "fixed" || s.value == "natural") {
        conditions_.push_back({part, s.value == "fixed"});
        if (s.value == "fixed") held[part] = s.key;
        continue;
      }
      if (s.value.starts_with(periodic)) {
        joined_.push_back({part, trimmed(std::string_view(s.value).substr(periodic.size()))});
        continue;
      }
      if (is_word(s.value, numbers))
        throw settings.error(
            s.key,
            "a part of a mesh is fixed, natural, periodic:PART, or moves by a formula of t, x, y and z; "
            "use one of them");
      motions_.push_back(data());
      conditions_.push_back({part, true});
      held[part] = s.key;
    }
    const Data& given = is_flux ? *fluxes_.back() : *motions_.back();
    if (key_of_formula_.empty()) key_of_formula_ = s.key;
    if (given.reads_time() && key_that_reads_time_.empty()) key_that_reads_time_ = s.key;
  }
  for (const auto& flux : fluxes_) {
    if (const auto kept = held.find(flux->part); kept != held.end())
      throw settings.error(
          flux->key, fmt::format("is for a natural part, and {} keeps the value; leave one of them out", kept->second));
    if (!keys.contains(flux->part)) conditions_.push_back({flux->part, false});
  }
  for (const JoinedParts& pair : joined_) {
    const auto other = keys.find(pair.with);
    const bool has_flux = std::ranges::any_of(
        fluxes_, [&](const auto& flux) { return flux->part == pair.with || flux->part == pair.part; });
    const bool agrees =
        other == keys.end() || settings.find(other->second)->value == fmt::format("{}{}", periodic, pair.part);
    if (!agrees || has_flux)
      throw settings.error(keys.at(pair.part),
                           fmt::format("both parts are one, and have no other condition; leave {} out",
                                       agrees ? "their flux" : other->second));
  }
  // Both keys of a pair may say so.
  for (std::size_t n = 0; n < joined_.size(); ++n)
    for (std::size_t m = joined_.size() - 1; m > n; --m)
      if (joined_[m].part == joined_[n].with) joined_.erase(joined_.begin() + static_cast<std::ptrdiff_t>(m));
}

bool keeps_constraint(double G, std::span<const double> slopes, std::span<const double> fields) {
  constexpr double rounding = 1e-12;
  return std::abs(G) <= rounding * std::max(1.0, constraint_terms(slopes, fields));
}

void MeshBoundary::put_on(MeshSpace& space) const {
  const Mesh& mesh = space.mesh;
  space.fixed = held_points(mesh, otherwise_fixed_, conditions_);
  const auto sides_of = [&](const std::string& name) {
    return std::ranges::find(mesh.parts, name, &Mesh::Part::name)->sides;
  };
  std::map<std::int32_t, std::shared_ptr<AtPlace>> driven, fluxes;
  for (const auto& motion : motions_)
    for (const auto& [point, share] : side_shares(mesh, sides_of(motion->part)))
      if (!driven.contains(point)) (driven[point] = std::make_shared<AtPlace>(mesh, point))->add(motion, 1);
  for (const auto& flux : fluxes_)
    for (const auto& [point, share] : side_shares(mesh, sides_of(flux->part))) {
      if (space.fixed[at(point)]) continue;
      if (!fluxes.contains(point)) fluxes[point] = std::make_shared<AtPlace>(mesh, point);
      fluxes[point]->add(flux, share);
    }
  for (const auto& [point, given] : driven) space.driven.push_back({point, given});
  for (const auto& [point, given] : fluxes) space.fluxes.push_back({point, given});
}

void MeshBoundary::require_constraint(const Settings& settings, const CellSpace& space) const {
  if (!space.constraint || space.driven.empty()) return;
  const std::size_t d = at(space.fields());
  std::vector<double> row(space.fields_of_row());
  for (const auto& [point, given] : space.driven)
    for (std::size_t a = 0; a < d; ++a) row[at(point) * d + a] = given->value(static_cast<int>(a), 0);
  std::map<std::size_t, double> broken;
  space.each_constraint(row, [&](std::size_t i, double G, std::span<const double> slopes) {
    if (!keeps_constraint(G, slopes, std::span(row).subspan(i * d, d))) broken.try_emplace(i, G);
  });
  for (const auto& motion : motions_)
    for (const auto& [point, share] :
         side_shares(space.mesh, std::ranges::find(space.mesh.parts, motion->part, &Mesh::Part::name)->sides))
      if (const auto one = broken.find(at(point)); one != broken.end())
        throw settings.error(motion->key,
                             fmt::format("breaks the constraint at point {} of the mesh, where it is {:.3g} "
                                         "and not 0 at t = 0; give formulas that keep it",
                                         space.mesh.point_number(one->first), one->second));
}

void refuse_keys_of_lattices(const Settings& settings) {
  for (const Setting& s : settings.all()) {
    if (!s.key.starts_with(of_boundary) || !find_key(s.key)) continue;
    constexpr std::array of_meshes{"boundary.mesh", "boundary.left", "boundary.right", "boundary.left.flux",
                                   "boundary.right.flux"};
    if (std::ranges::find(of_meshes, s.key) == of_meshes.end())
      throw settings.error(s.key,
                           fmt::format("is a key of lattices; a part of a mesh that has this name is boundary.part.{}",
                                       s.key.substr(of_boundary.size())));
  }
}

}  // namespace delf
