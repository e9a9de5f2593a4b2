// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <vector>

#include "jets/tables/named_splittings.hpp"
#include "jets/tables/named_tables.hpp"
#include "jets/tables/time_tableau.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/cite/citation.hpp"
#include "tools/cite/references.hpp"
#include "tools/peers/body_peers.hpp"
#include "tools/peers/peer.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/values.hpp"

using namespace delf;
using testing::contains;

namespace {

struct Sourced {
  std::string name;
  std::vector<std::string> sources;
};

/// A line for each entry without sources, and for each source that is no reference.
std::vector<std::string> complaints_about(const std::vector<Sourced>& entries) {
  std::vector<std::string> lines;
  for (const Sourced& entry : entries) {
    if (entry.sources.empty()) lines.push_back(entry.name + " names no source");
    for (const std::string& key : entry.sources)
      if (!find_reference(key)) lines.push_back(entry.name + " names " + key + ", which is no reference");
  }
  return lines;
}

std::vector<Sourced> all_entries() {
  std::vector<Sourced> entries;
  for (const TheoryEntry* t : theory_entries()) entries.push_back({"theory " + t->name, t->sources});
  for (const MethodEntry* m : method_entries()) entries.push_back({"method " + m->name, m->sources});
  for (const StateEntry* s : state_entries()) entries.push_back({"state " + s->name, s->sources});
  for (const NamedTable& t : named_tables()) entries.push_back({"stencil " + t.name, t.sources});
  for (const NamedSplitting& s : named_splittings()) entries.push_back({"splitting " + s.name, s.sources});
  for (const TimeTableau& t : time_tableaux()) entries.push_back({"tableau " + t.name, t.sources});
  for (const peers::PeerInfo& p : peers::peers()) entries.push_back({"peer " + p.name, p.sources});
  for (const peers::BodyPeerInfo& p : peers::body_peers("kepler")) entries.push_back({"peer " + p.name, p.sources});
  return entries;
}

}  // namespace

TEST_CASE("every theory, method, state, stencil, splitting, tableau and peer names sources that are references") {
  // other tests of this program register entries of their own, which are no part of delf
  std::vector<Sourced> entries = all_entries();
  std::erase_if(entries, [](const Sourced& e) { return contains(e.name, " own-"); });
  CHECK(complaints_about(entries) == std::vector<std::string>{});
  entries.push_back({"theory planted", {}});
  entries.push_back({"state planted", {"delf", "nobody-1900"}});
  CHECK(complaints_about(entries) ==
        std::vector<std::string>{"theory planted names no source",
                                 "state planted names nobody-1900, which is no reference"});
}

TEST_CASE("what compiled entries are called in a paper is said by each theory, stencil and tableau") {
  for (const TheoryEntry* t : theory_entries())
    if (t->chosen_by.empty() && !t->name.starts_with("own-")) CHECK_FALSE(t->words.empty());
  for (const NamedTable& t : named_tables()) CHECK_FALSE(t.words.empty());
  for (const TimeTableau& t : time_tableaux()) CHECK_FALSE(t.words.empty());
}

TEST_CASE("references have what a citation needs, and say against what they were checked") {
  std::set<std::string> keys, dois;
  for (const CitedWork& r : references()) {
    INFO(r.key);
    CHECK(keys.insert(r.key).second);
    CHECK_FALSE(r.field("author").empty());
    CHECK_FALSE(r.field("title").empty());
    CHECK_FALSE(r.field("checked").empty());
    if (r.type != "misc") CHECK(r.field("year").size() == 4);
    if (r.type == "article") CHECK_FALSE(r.field("journal").empty());
    // a DOI stands only where a record of it was found
    const std::string doi = r.field("doi");
    CHECK(doi.empty() != r.field("checked").starts_with("DOI"));
    if (!doi.empty()) {
      CHECK(doi.starts_with("10."));
      CHECK(dois.insert(doi).second);
    }
    CHECK(contains(in_words(r), doi));
    CHECK_FALSE(contains(in_words(r), "{"));
  }
  CHECK(references().size() > 50);
}

TEST_CASE("references are read from their entries") {
  const CitedWork* marsden = find_reference("marsden-patrick-shkoller-1998");
  REQUIRE(marsden);
  CHECK(marsden->type == "article");
  CHECK(marsden->is_checked());
  CHECK(contains(marsden->bibtex, "@article{marsden-patrick-shkoller-1998,"));
  CHECK(
      in_words(*marsden) ==
      "J. E. Marsden, G. W. Patrick, S. Shkoller, Multisymplectic geometry, variational integrators, and nonlinear PDEs, "
      "Communications in Mathematical Physics 199 (1998) 351–395, doi:10.1007/s002200050505");
  // the paper that CITATION.cff asks to be cited
  CHECK(contains(citation, marsden->field("doi")));
  const CitedWork* delf = find_reference("delf");
  REQUIRE(delf);
  CHECK(contains(delf->bibtex, "author = {{The delf authors}}"));
  CHECK(contains(in_words(*delf), "a discrete multisymplectic lattice engine"));
  CHECK_FALSE(find_reference("kouranbaeva-shkoller-2000")->is_checked());
  CHECK(in_words(*find_reference("ryckaert-ciccotti-berendsen-1977"))
            .starts_with("J.-P. Ryckaert, G. Ciccotti, H. J. C. Ber"));
  CHECK_FALSE(find_reference("nobody-1900"));
}

TEST_CASE("sources that shipped scenes name are references") {
  std::vector<Sourced> scenes;
  for (const ShippedScene& scene : shipped_scenes()) {
    const Settings settings = read_settings(find_scene(scene.name), {});
    for (const std::string& key : parts_of(Values(settings).text("cite.sources").value_or("")))
      if (!key.empty()) scenes.push_back({scene.name, {key}});
  }
  CHECK(scenes.size() > 10);
  CHECK(complaints_about(scenes) == std::vector<std::string>{});
}
