// SPDX-License-Identifier: MIT
#include "tools/command_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>

#include "lattice/text_parts.hpp"
#include "tools/commands.hpp"
#include "tools/help.hpp"
#include "tools/scene/keys.hpp"

namespace delf {

namespace {

namespace po = boost::program_options;

po::parsed_options parsed(const std::vector<std::string>& words) {
  po::options_description known;
  known.add_options()("help", "")("version", "")("latex", "")("overwrite", "")("out", po::value<std::string>());
  known.add_options()("modified", po::value<std::string>());
  known.add_options()("fields", po::value<std::string>())("nearby", po::value<std::string>());
  known.add_options()("dataset", po::value<std::string>());
  for (const Parameter& key : keys()) known.add_options()(key.key.c_str(), po::value<std::string>());
  using namespace po::command_line_style;
  constexpr int exact_names = allow_long | long_allow_adjacent | long_allow_next;  // no guessing
  try {
    return po::command_line_parser(words).options(known).style(exact_names).allow_unregistered().run();
  } catch (const po::error& error) {
    throw BadScene(fmt::format("command line: {}; write --KEY=VALUE", error.what()));
  }
}

Arguments taken_apart(const std::vector<std::string>& words) {
  Arguments arguments;
  std::string dataset;
  for (const auto& option : parsed(words).options) {
    const std::string value = option.value.empty() ? "" : trimmed(option.value.front());
    if (option.string_key == "help" || value == "-h") {
      arguments.help = true;
    } else if (option.string_key == "version" && !option.unregistered) {
      arguments.version = true;
    } else if (option.string_key == "latex" && !option.unregistered) {
      arguments.latex = true;
    } else if (option.string_key == "modified") {
      if (value != "2" && value != "4" && value != "6")
        throw BadScene(
            fmt::format("command line: --modified={}: is the order in h and k of its last terms, 2, 4 or 6; "
                        "choose one, or leave it out for 4",
                        value));
      arguments.modified = value[0] - '0';
    } else if (option.string_key == "overwrite" && !option.unregistered) {
      arguments.overwrite = true;
    } else if (option.string_key == "out") {
      if (value.empty()) throw BadScene("command line: --out: give a directory, as --out DIR");
      if (arguments.out)
        throw BadScene(fmt::format("command line: --out {}: is a second one, after --out {}; keep one of them", value,
                                   *arguments.out));
      arguments.out = value;
    } else if (option.string_key == "fields") {
      if (arguments.fields || value.empty())
        throw BadScene("command line: --fields: give one file of rows, as --fields FILE");
      arguments.fields = value;
    } else if (option.string_key == "nearby") {
      if (value.empty()) throw BadScene("command line: --nearby: give a file of rows, as --nearby FILE");
      arguments.nearby.push_back(value);
    } else if (option.string_key == "dataset") {
      if (value.empty()) throw BadScene("command line: --dataset: give the name of a data set, as --dataset u");
      dataset = value.starts_with('/') ? value : "/" + value;
    } else if (!option.string_key.empty()) {
      arguments.keys.push_back({option.string_key, value, 0});
    } else if (value.size() > 1 && value.front() == '-') {
      throw BadScene(fmt::format("command line: {}: unknown option; keys are given as --KEY=VALUE", value));
    } else {
      arguments.words.push_back(value);
    }
  }
  if (!dataset.empty()) {
    if (!arguments.fields) throw BadScene("command line: --dataset: of which file? Give it too, as --fields FILE");
    *arguments.fields += ":" + dataset;
    for (std::string& file : arguments.nearby) file += ":" + dataset;
  }
  return arguments;
}

void check_files_of_rows(const Command& command, const Arguments& arguments) {
  const bool nearby = !arguments.nearby.empty();
  if ((arguments.fields || nearby) && !command.reads_rows)
    throw BadScene(fmt::format("command line: {}: `{}` reads no recorded rows; leave it out",
                               arguments.fields ? "--fields" : "--nearby", command.name));
  if (nearby && !arguments.fields)
    throw BadScene("command line: --nearby: near to which rows? Give them too, as --fields FILE");
}

ExitCode carry_out(std::vector<std::string> words) {
  std::ranges::replace(words, "--modified", "--modified=4");  // it takes no word after it
  Arguments arguments = taken_apart(words);
  if (arguments.version) {
    fmt::print("delf {}\n", DELF_VERSION);
    return ExitCode::done;
  }
  if (arguments.help) return help(arguments.words.empty() ? "" : arguments.words.front());
  if (arguments.words.empty()) {
    check_command_line(arguments.keys);
    fmt::print("{}", usage());
    return ExitCode::bad_input;
  }
  const Command& command = find_command(arguments.words.front());
  check_files_of_rows(command, arguments);
  if (arguments.latex && !command.writes_latex)
    throw BadScene(fmt::format("command line: --latex: `{}` prints no formulas; `delf plan` does", command.name));
  if (arguments.modified && !command.writes_latex)
    throw BadScene(
        fmt::format("command line: --modified: `{}` prints no modified Lagrangian; `delf plan` does", command.name));
  if (arguments.overwrite && !command.keeps_earlier)
    throw BadScene(
        fmt::format("command line: --overwrite: `{}` keeps nothing of an earlier run; `delf run` does", command.name));
  return command.carry_out(arguments);
}

// The first files that are opened would take the places of standard streams that are closed.
void open_standard_streams() {
  for (const int stream : {0, 1, 2})
    while (fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      if (open("/dev/null", O_RDWR) < 0) return;
}

}  // namespace

ExitCode run_program(const std::vector<std::string>& words) {
  ExitCode code = ExitCode::done;
  open_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);  // whoever reads no more is reported like a full disk, and ends no run
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is reported like a full disk, and does not kill the program
  const SystemFailure no_output("standard output cannot be written to");
  try {
    code = carry_out(words);
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw no_output;
  } catch (const std::exception& error) {
    std::fflush(stdout);
    // a long text fails where it is printed, in the words of fmt
    const bool of_output = std::ferror(stdout) && dynamic_cast<const std::system_error*>(&error);
    std::fputs((error_line(of_output ? no_output : error) + "\n").c_str(), stderr);
    code = exit_code(error);
  }
  return code;
}

}  // namespace delf
