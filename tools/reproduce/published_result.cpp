// SPDX-License-Identifier: MIT
#include "tools/reproduce/published_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "lattice/nearest_name.hpp"
#include "lattice/text_parts.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene_text.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

using Member = std::string PublishedResult::*;
const std::vector<std::pair<std::string, Member>> members{
    {"title", &PublishedResult::title},     {"reference", &PublishedResult::reference},
    {"doi", &PublishedResult::doi},         {"where", &PublishedResult::where},
    {"command", &PublishedResult::command}, {"keys", &PublishedResult::keys},
    {"scene", &PublishedResult::scene},     {"number", &PublishedResult::number},
    {"correct", &PublishedResult::correct}, {"because", &PublishedResult::because},
    {"differs", &PublishedResult::differs}, {"tolerance", &PublishedResult::tolerance},
    {"checked", &PublishedResult::checked}};
const std::vector<std::string> other_keys{"like", "slow"};

/// The lines of a file of results: [ID] begins one, an indented line goes on with the value above it, and # is a comment.
class ResultsFile {
 public:
  ResultsFile(const fs::path& file, std::vector<PublishedResult>& all) : file_(file), all_(all) {
    paper_.paper = file.stem().string();
    std::istringstream in(read_scene_text(file));
    std::string line;
    while (std::getline(in, line)) ++number_, take(line);
    put();
    finish();
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw BadScene(fmt::format("{}:{}: {}", file_.string(), line, what));
  }

  void take(const std::string& line) {
    const std::string text = trimmed(line);
    if (!key_.empty() && !line.empty() && std::isspace(static_cast<unsigned char>(line.front()))) {
      if (!text.empty()) value_ += (value_.empty() ? "" : "\n") + text;
    } else if (text.empty() || text.front() == '#') {
      put();
    } else if (text.front() == '[' && text.back() == ']') {
      put();
      begin(trimmed(text.substr(1, text.size() - 2)));
    } else {
      put();
      const auto equals = text.find('=');
      if (equals == text.npos)
        refuse(number_, fmt::format("\"{}\" is neither an [id] nor key = value", text.substr(0, 60)));
      key_ = trimmed(text.substr(0, equals)), value_ = trimmed(text.substr(equals + 1));
    }
  }

  void begin(const std::string& id) {
    if (std::ranges::find(all_, id, &PublishedResult::id) != all_.end())
      refuse(number_, fmt::format("[{}]: is there already; choose another id", id));
    const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.'; };
    if (id.empty() || id.front() == '.' || !std::ranges::all_of(id, plain))
      refuse(number_, fmt::format("[{}]: an id names a folder; write it with letters, digits, - and .", id));
    PublishedResult result = paper_;
    result.id = id, result.file = file_, result.line = number_;
    all_.push_back(result);
    ++mine_;
  }

  // The value of the key that has ended.
  void put() {
    if (key_.empty()) return;
    PublishedResult& now = mine_ == 0 ? paper_ : all_.back();
    const auto member = std::ranges::find(members, key_, &std::pair<std::string, Member>::first);
    if (key_ == "slow") {
      if (value_ != "yes" && value_ != "no") refuse(number_, fmt::format("slow = {}: yes or no", value_));
      now.slow = value_ == "yes";
    } else if (key_ == "like") {
      take_from(now);
    } else if (std::ranges::find(kinds_of_results, key_) != kinds_of_results.end()) {
      now.kind = key_, now.expected = value_;
    } else if (member == members.end()) {
      std::vector<std::string> known = other_keys;
      known.insert(known.end(), kinds_of_results.begin(), kinds_of_results.end());
      for (const auto& [name, of] : members) known.push_back(name);
      refuse(number_, fmt::format("{}: unknown key{}", key_, suggestion(key_, known)));
    } else {
      now.*(member->second) = value_;
    }
    key_.clear(), value_.clear();
  }

  // like = ID: what that one says holds here too, but for what stands below; its correction and its reasons are its own.
  void take_from(PublishedResult& now) {
    const auto other = std::ranges::find(all_, value_, &PublishedResult::id);
    if (other == all_.end() || other->id == now.id)
      refuse(number_, fmt::format("like = {}: no result above has this id", value_));
    for (const auto& [name, member] : members)
      if (member != &PublishedResult::correct && member != &PublishedResult::differs) now.*member = (*other).*member;
    now.kind = other->kind, now.expected = other->expected, now.slow = other->slow;
  }

  void finish() {
    for (auto r = all_.end() - mine_; r != all_.end(); ++r)
      for (const auto& [name, value] : {std::pair{"command", r->command},
                                        {"number", r->number},
                                        {"printed", r->expected},
                                        {"reference", r->reference},
                                        {"where", r->where},
                                        {"checked", r->checked},
                                        {"title", r->title}})
        if (value.empty()) refuse(r->line, fmt::format("[{}]: has no `{}`; give it", r->id, name));
  }

  fs::path file_;
  std::vector<PublishedResult>& all_;
  PublishedResult paper_;
  std::ptrdiff_t mine_ = 0;
  int number_ = 0;
  std::string key_, value_;
};

}  // namespace

std::string PublishedResult::place() const { return fmt::format("{}:{}: {}", file.string(), line, id); }

std::vector<PublishedResult> published_results() {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(shipped_folder("results"), none))
    if (entry.path().extension() == ".ini") files.push_back(entry.path());
  if (files.empty()) throw BadScene("no published results are installed; install the folder of scenes");
  std::ranges::sort(files);
  std::vector<PublishedResult> all;
  for (const fs::path& file : files) ResultsFile(file, all);
  return all;
}

std::vector<PublishedResult> chosen_results(const std::vector<std::string>& names, const std::string& slow) {
  const std::vector<PublishedResult> all = published_results();
  std::vector<PublishedResult> chosen;
  const auto wanted = [&](const PublishedResult& r) { return slow == "on" || r.slow == (slow == "only"); };
  if (names.empty()) std::ranges::copy_if(all, std::back_inserter(chosen), wanted);
  for (const std::string& name : names) {
    bool known = false;
    for (const PublishedResult& r : all) {
      if (r.id != name && r.paper != name) continue;
      known = true;
      const bool twice = std::ranges::find(chosen, r.id, &PublishedResult::id) != chosen.end();
      if (!twice && (r.id == name || wanted(r))) chosen.push_back(r);
    }
    if (known) continue;
    std::vector<std::string> ids;
    for (const PublishedResult& r : all) ids.push_back(r.id), ids.push_back(r.paper);
    const auto close = nearest(name, ids);
    throw BadScene(
        fmt::format("command line: reproduce {}: no such result{}", name,
                    close ? fmt::format("; did you mean {}?", *close) : "; `delf list results` has them all"));
  }
  if (chosen.empty())
    throw BadScene(fmt::format("command line: reproduce{}{}: all results there are {}", names.empty() ? "" : " ",
                               fmt::join(names, " "),
                               slow == "only" ? "fast; leave out --reproduce.slow" : "slow; add --reproduce.slow=on"));
  return chosen;
}

}  // namespace delf
