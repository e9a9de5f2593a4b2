// SPDX-License-Identifier: MIT
#include "tools/page/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>

#include "tools/cite/citation.hpp"
#include "tools/cite/cite.hpp"
#include "tools/cite/methods_text.hpp"
#include "tools/cite/references.hpp"
#include "tools/files/text_file.hpp"
#include "tools/page/captions.hpp"
#include "tools/page/markup.hpp"
#include "tools/page/numbers.hpp"
#include "tools/page/page_figures.hpp"
#include "tools/page/solved.hpp"
#include "tools/page/verdict.hpp"
#include "tools/report/machine.hpp"
#include "tools/results/same_scene.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_bytes = 1000000;

std::string verdict_boxes(const ResultFolder& folder) {
  std::string html;
  for (const PageVerdict& verdict : verdicts_of(folder))
    html +=
        fmt::format("<div class=\"verdict{}\"><p><strong>{}</strong> {}</p>\n{}</div>\n", verdict.good ? " good" : "",
                    verdict.good ? "Good." : "Attention.", escaped(verdict.sentence), list(verdict.points));
  return html;
}

std::string numbers_section(const ResultFolder& folder) {
  PageTable t{"Numbers of the run", {"number", "value", "meaning", "worry when"}, {}};
  for (const PageNumber& n : numbers_of(folder))
    t.rows.push_back({n.name, n.value, n.meaning, n.worrying ? "beyond it here: " + n.worry : n.worry});
  std::string html = table(t);
  if (html.empty()) html = paragraph("There is no summary.json, which has the numbers of a run.");
  return html;
}

std::string figure_html(const PageFigure& figure, const FigureCaption& caption, const std::string& beside) {
  const std::string image =
      figure.source.empty()
          ? paragraph(fmt::format("{} is {}.", figure.file,
                                  figure.file.ends_with(".svg") || figure.file.ends_with(".png")
                                      ? "too large for this page"
                                      : "of a format that the page does not show: output.format = svg is"))
          : fmt::format("<img alt=\"{}\" src=\"{}\"/>\n", escaped(caption.title + beside), figure.source);
  const std::string link =
      figure.film.empty() ? "" : fmt::format(" <a href=\"{0}\">Watch the film, {0}</a>.", escaped(figure.film));
  return fmt::format("<figure>\n{}<figcaption>{}.{} {}{}</figcaption>\n{}</figure>\n", image, escaped(caption.title),
                     escaped(beside), escaped(caption.finding), link, details("The numbers as a table", caption.table));
}

std::string figures_section(const ResultFolder& folder, const std::vector<PageFigure>& figures) {
  std::string html;
  for (const PageFigure& figure : figures) html += figure_html(figure, caption_of(folder, figure.name), "");
  if (!html.empty()) return html;
  const auto asked = folder.keys.find("output.figures");
  const bool off = asked != folder.keys.end() && asked->second == "off";
  return paragraph(off ? "There are no figures: output.figures is off."
                       : "There are no figures: gnuplot is missing, or they were not drawn.");
}

std::string verification_section(const ResultFolder& folder) {
  const Json* verify = folder.result("verify");
  std::string html = table_of("Checks: each sum is zero in theory, and is divided by its absolute terms",
                              {{"check", "name"},
                               {"passed", "passed"},
                               {"largest", "value"},
                               {"tolerance", "tolerance"},
                               {"count", "count"},
                               {"where", "region"}},
                              list_in(verify, "checks"));
  html += table_of("Measured, but not promised",
                   {{"quantity", "name"}, {"value", "value"}, {"order in h", "order"}, {"where", "region"}},
                   list_in(verify, "measured"));
  html += table_of("Quantities that symmetries conserve, and energies of the scheme itself",
                   {{"quantity", "name"}, {"row 0", "initial"}, {"last row", "final"}, {"largest change", "error_max"}},
                   list_in(folder.result("summary"), "conserved"));
  if (const auto left_out = texts_in(verify, "left_out"); !left_out.empty())
    html += paragraph("Left out:") + list(left_out);
  if (!other_scene(folder).empty())
    html = paragraph("These are checks of another scene, and say nothing of the rows in this folder.") + html;
  if (!verify) html += paragraph("These rows have not been verified here. `delf verify scene.ini` does it.");
  return html;
}

std::string monitors_section(const ResultFolder& folder) {
  PageTable t{"Columns of series.csv", {"column", "first", "least", "largest", "last"}, {}};
  for (std::size_t c = 2; c < folder.series.columns.size(); ++c) {
    std::vector<double> values = folder.series.columns[c];
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) continue;
    const auto [least, most] = std::ranges::minmax(values);
    t.rows.push_back({folder.series.names[c], number_text(values.front()), number_text(least), number_text(most),
                      number_text(values.back())});
  }
  const std::string html = table(t) + details("Some rows of series.csv", csv_table(folder, "series.csv", 31));
  return html.empty() ? paragraph("There is no series.csv, which has a line for each recorded row.") : html;
}

/// The command of a sweep, with all values of its keys.
std::string sweep_command(const Json* sweep, bool has_scene) {
  const std::string command = text_in(sweep, "command");
  std::string text = fmt::format("delf {} {}", command.empty() ? "sweep" : command, has_scene ? "scene.ini" : "SCENE");
  const std::vector<Json> runs = list_in(sweep, "runs");
  const auto value_of = [](const Json& run, const std::string& key) {
    const auto settings = run.is_object() ? run.find("settings") : run.end();
    return settings == run.end() ? "" : text_in(&*settings, key);
  };
  for (const std::string& key : texts_in(sweep, "keys")) {
    std::vector<std::string> values;
    for (const Json& run : runs)
      if (const std::string value = value_of(run, key); std::ranges::find(values, value) == values.end())
        values.push_back(value);
    if (sweep->contains("threshold") && !values.empty()) {  // all values are between those that it began with
      const auto [low, high] =
          std::ranges::minmax(values, {}, [](const std::string& v) { return std::strtod(v.c_str(), nullptr); });
      text += fmt::format(" --sweep.bisect={}={}:{}", key, low, high);
    } else text += fmt::format(" --{}={}", key, fmt::join(values, ","));
  }
  if (const auto threshold = sweep->find("threshold"); threshold != sweep->end())
    text += fmt::format(" --sweep.level={} --sweep.number={}", number_text(number_in(&*threshold, "level")),
                        text_in(&*threshold, "number"));
  if (number_in(sweep, "runs_asked").value_or(0) > static_cast<double>(runs.size()))
    text += "\n# It was interrupted: values of runs that were not made are not known.";
  return text;
}

std::string again_section(const ResultFolder& folder) {
  if (folder.scene.empty()) return paragraph("There is no scene.ini here, so no command can be given.");
  static const std::vector<std::pair<std::string, std::string>> commands{{"verify", "verify"},
                                                                         {"convergence", "convergence"},
                                                                         {"workprecision", "workprecision"},
                                                                         {"stability", "stability"}};
  std::string text;
  if (folder.result("summary") || folder.results.empty()) text = "delf run scene.ini\n";
  for (const auto& [result, command] : commands)
    if (const Json* json = folder.result(result)) {
      const std::string rows = text_in(json, "subject");  // of a verification
      text += fmt::format("delf {} scene.ini{}\n", command,
                          rows.empty() || rows == "rows computed here" ? "" : " --fields FILE");
    }
  const bool own = folder.scene_file == folder.path / "scene.ini";  // else it is that of the first run of a sweep
  if (const Json* sweep = folder.result("sweep")) text += sweep_command(sweep, own) + "\n";
  return paragraph(
             own ? "scene.ini has every key in force. On the same machine and build it gives the same rows, to the bit."
                 : "SCENE is the scene that the runs were made of, with the keys that were given beside those with several "
                   "values. The scene.ini of a run gives its rows; this is that of the first.") +
         code_block("The command", text) + code_block("scene.ini", folder.scene);
}

std::string made_section(const ResultFolder& folder) {
  PageTable t{"Program and machine", {}, {}};
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) t.rows.push_back({name, value});
  };
  for (const std::string& kind : ResultFolder::kinds())
    if (const Json* json = folder.result(kind)) {
      add(kind + ".json: version of delf", text_in(json, "version"));
      add(kind + ".json: machine", text_in(json, "machine"));
      add(kind + ".json: compiler and flags", text_in(json, "compiler"));
      add(kind + ".json: seed", value_text(json, "seed"));
    }
  add("this page: version of delf", DELF_VERSION);
  add("this page: machine", machine_in_words());
  add("this page: compiler and flags", compiler_in_words());
  return table(t);
}

std::string files_section(const ResultFolder& folder) {
  PageTable t{"Files of the folder", {"file", "bytes", "SHA-256"}, {}};
  for (const ResultFolder::File& file : folder.files)
    t.rows.push_back(
        {file.name, fmt::to_string(file.bytes), file.sha256.empty() ? "not found: sha256sum is missing" : file.sha256});
  std::string html = table(t);
  if (folder.further_files > 0) html += paragraph(fmt::format("There are {} more files.", folder.further_files));
  return html + (folder.missing.empty() ? "" : "<h3>Missing</h3>\n" + list(folder.missing));
}

/// The references that the scenes of the folders rest on.
std::string references_section(const std::vector<ResultFolder>& folders) {
  constexpr int most_sites = 200000;  // of which a simulation is made in no time
  std::vector<std::string> keys, lines;
  for (const ResultFolder& folder : folders) {
    try {
      if (folder.scene.empty() || number_in(folder.result("summary"), "sites").value_or(0) > most_sites) continue;
      const AnyScene scene = read_any_scene(read_settings(folder.scene_file, {}));
      for (const std::string& key : std::visit([&](const auto& s) { return methods_text(s, &folder); }, scene).cited())
        if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    } catch (const std::exception&) {  // whose equations are not shown either, with the reason
    }
  }
  for (const std::string& key : keys)
    if (const CitedWork* reference = find_reference(key)) lines.push_back(in_words(*reference));
  if (lines.empty()) return {};
  return paragraph(
             "The results rest on these publications and programs; `delf cite` writes a methods section with them:") +
         list(lines) + details("references.bib", code_block("references.bib", bibliography_of(keys)));
}

/// The keys in which the scenes of several folders differ.
std::string differences(const std::vector<ResultFolder>& folders) {
  PageTable t{"Keys that differ", {"key"}, {}};
  std::set<std::string> keys;
  for (const ResultFolder& folder : folders) {
    t.headings.push_back(folder.path.string());
    for (const auto& [key, value] : folder.keys) keys.insert(key);
  }
  for (const std::string& key : keys) {
    std::vector<std::string> row{key};
    for (const ResultFolder& folder : folders) {
      const auto found = folder.keys.find(key);
      row.push_back(found == folder.keys.end() ? "not given" : found->second);
    }
    if (std::ranges::count(row, row[1]) != static_cast<std::ptrdiff_t>(folders.size())) t.rows.push_back(row);
  }
  return t.rows.empty() ? paragraph("The scenes have the same keys.") : table(t);
}

std::string numbers_beside(const std::vector<ResultFolder>& folders) {
  PageTable t{"Numbers side by side", {"number"}, {}};
  std::vector<std::vector<PageNumber>> all;
  for (const ResultFolder& folder : folders) {
    t.headings.push_back(folder.path.string());
    all.push_back(numbers_of(folder));
    for (const PageNumber& n : all.back())
      if (std::ranges::none_of(t.rows, [&](const auto& row) { return row[0] == n.name; })) t.rows.push_back({n.name});
  }
  for (auto& row : t.rows)
    for (const auto& numbers : all) {
      const auto found = std::ranges::find(numbers, row[0], &PageNumber::name);
      row.push_back(found == numbers.end() ? "" : found->value);
    }
  return table(t);
}

std::string figures_beside(const std::vector<ResultFolder>& folders,
                           const std::vector<std::vector<PageFigure>>& figures) {
  std::vector<std::string> names;
  for (const ResultFolder& folder : folders)
    for (const std::string& name : folder.figures)
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  std::string html;
  for (const std::string& name : names) {
    html += "<div class=\"pair\">\n";
    for (std::size_t f = 0; f < folders.size(); ++f)
      for (const PageFigure& figure : figures[f])
        if (figure.name == name)
          html += figure_html(figure, caption_of(folders[f], name), fmt::format(" ({})", folders[f].path.string()));
    html += "</div>\n";
  }
  return html;
}

/// A part of a page: the end of its id, its heading, and its contents.
struct Part {
  std::string id, heading, html;
};

std::string with_contents(const std::vector<Part>& parts) {
  std::string links, html;
  for (const Part& part : parts) {
    links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(part.id), escaped(part.heading));
    html += section(part.id, part.heading, part.html);
  }
  return fmt::format("<nav aria-label=\"Contents\"><ul>\n{}</ul></nav>\n{}", links, html);
}

std::string page_with(const std::vector<ResultFolder>& folders, const std::vector<std::vector<PageFigure>>& figures) {
  std::vector<Part> parts;
  std::string title, lead;
  const bool several = folders.size() > 1;
  if (several) {
    title = "Runs side by side";
    for (const ResultFolder& folder : folders)
      lead += fmt::format("<h3>{}</h3>\n", escaped(folder.path.string())) + verdict_boxes(folder);
    lead = section("verdict", "Verdicts", lead);
    parts = {{"differences", "Differences", differences(folders)},
             {"numbers", "Numbers", numbers_beside(folders)},
             {"figures", "Figures", figures_beside(folders, figures)}};
  } else {
    title = fmt::format("{}: results of delf", folders[0].name);
    lead = section("verdict", "Verdict", verdict_boxes(folders[0]));
  }
  for (std::size_t f = 0; f < folders.size(); ++f) {
    const ResultFolder& folder = folders[f];
    const SolvedProblem solved = solved_problem(folder);
    const std::string id = several ? fmt::format("run-{}-", f + 1) : "",
                      of = several ? " of " + folder.path.string() : "";
    const auto add = [&](const char* own, const char* heading, std::string html) {
      parts.push_back({id + own, heading + of, std::move(html)});
    };
    add("solved", "Problem", solved.what);
    add("scheme", "Scheme", solved.how);
    if (!several) add("numbers", "Numbers", numbers_section(folder));
    if (!several) add("figures", "Figures", figures_section(folder, figures[f]));
    add("verification", "Verification", verification_section(folder));
    add("monitors", "Monitors", monitors_section(folder));
    add("again", "Scene and command", again_section(folder));
    add("made", "Program and machine", made_section(folder));
    add("files", "Files", files_section(folder));
  }
  parts.push_back(
      {"cite", "Citation",
       paragraph("Cite the program, and the paper whose construction it generalises, as CITATION.cff says:") +
           code_block("CITATION.cff", citation) + references_section(folders)});
  return document(title, fmt::format("<main>\n<h1>{}</h1>\n{}{}</main>\n", escaped(title), lead, with_contents(parts)));
}

/// A path as a relative URL.
std::string url_of(const fs::path& path) {
  std::string url;
  for (const char c : path.generic_string())
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("-._~/").find(c) != std::string_view::npos)
      url += c;
    else url += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return url.starts_with('/') ? "file://" + url : url;
}

}  // namespace

std::string page_of(const std::vector<fs::path>& paths, const fs::path& place) {
  std::vector<ResultFolder> folders;
  for (const fs::path& path : paths) folders.emplace_back(path, "report").list_files();
  constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
  const auto figures_of = [&](std::size_t most) {
    auto figures = page_figures(folders, most);
    for (std::size_t f = 0; f < folders.size(); ++f)
      for (PageFigure& figure : figures[f])
        if (!figure.film.empty()) figure.film = url_of(fs::proximate(folders[f].path / figure.film, place));
    return figures;
  };
  std::string page = page_with(folders, figures_of(no_limit));
  if (page.size() <= most_bytes) return page;
  // Figures have the room that the rest of the page leaves.
  const std::size_t rest = page_with(folders, figures_of(0)).size();
  return page_with(folders, figures_of(most_bytes - std::min(rest, most_bytes)));
}

ExitCode write_page(const std::vector<fs::path>& folders, const std::optional<std::string>& out) {
  const fs::path file = out                   ? fs::path(*out)
                        : folders.size() == 1 ? folders[0] / "report.html"
                                              : fs::path("report.html");
  const std::string page = page_of(folders, file.has_parent_path() ? file.parent_path() : ".");
  write_text_file(file, page);
  if (page.size() > most_bytes)
    std::fputs(
        fmt::format("delf: {}: is larger than a million bytes; {}\n", file.string(),
                    folders.size() > 1 ? "name fewer folders" : "its files have more text than a page has room for")
            .c_str(),
        stderr);
  fmt::print("{}: {} bytes\n", file.string(), page.size());
  return ExitCode::done;
}

}  // namespace delf
