// SPDX-License-Identifier: MIT
#include "tools/bench/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "lattice/error.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/machine.hpp"
#include "tools/bench/textbook/textbook.hpp"

namespace delf::bench {

namespace {

namespace po = boost::program_options;

struct Command {
  const char* name;
  const char* what;
  void (*carry_out)(const Request&);
};
constexpr Command commands[] = {
    {"schemes", "the engine against a textbook implementation, scheme by scheme", time_schemes},
    {"limit", "against what the machine allows: sines, memory, a loop written by hand, an auto-vectorised one",
     time_limit},
    {"sizes", "ns per site and step over the number of sites", time_sizes},
    {"density", "a user's density against the same one built in", time_density},
    {"monitors", "what monitors and residuals cost at every step", time_monitors},
    {"threads", "two threads against one", time_threads},
    {"slabs", "steps slab by slab against programs written for one system", time_slabs},
    {"verify", "checking a stencil against stepping it", time_verify},
};

struct BadOption : std::runtime_error {
  using std::runtime_error::runtime_error;
};

po::options_description known_options() {
  po::options_description options("options");
  options.add_options()("help", "this text");
  options.add_options()("sites", po::value<std::vector<int>>()->multitoken(), "numbers of sites, 16 to 100000000");
  options.add_options()("tolerance", po::value<std::vector<double>>()->multitoken(), "of implicit steps");
  options.add_options()("scheme", po::value<std::vector<std::string>>()->multitoken(), "stencils and methods");
  options.add_options()("repeats", po::value<int>()->default_value(15), "repetitions that medians are of");
  return options;
}

void print_help() {
  fmt::print("delf-bench COMMAND [OPTIONS]\n\n");
  for (const Command& command : commands) fmt::print("  {:<10} {}\n", command.name, command.what);
  std::ostringstream text;
  text << known_options();
  fmt::print("\n{}", text.str());
}

template <class T>
std::vector<T> list(const po::variables_map& given, const char* name) {
  return given.count(name) ? given[name].as<std::vector<T>>() : std::vector<T>{};
}

Request checked(const po::variables_map& given) {
  Request request{list<int>(given, "sites"), list<double>(given, "tolerance"), list<std::string>(given, "scheme"),
                  given["repeats"].as<int>()};
  for (const int sites : request.sites)
    if (sites < 16 || sites > 100'000'000) throw BadOption(fmt::format("--sites {}: give 16 to 100000000", sites));
  for (const double tolerance : request.tolerances)
    if (!(tolerance > 0 && tolerance < 1)) throw BadOption(fmt::format("--tolerance {}: give 0 < t < 1", tolerance));
  for (const std::string& scheme : request.schemes)
    if (const auto& names = textbook_schemes(); std::ranges::find(names, scheme) == names.end())
      throw BadOption(fmt::format("--scheme {}: unknown; choose from {}", scheme, fmt::join(names, ", ")));
  if (request.repeats < 1 || request.repeats > 1000)
    throw BadOption(fmt::format("--repeats {}: give 1 to 1000", request.repeats));
  return request;
}

void carry_out(const std::vector<std::string>& words) {
  const std::string name = words.empty() || words.front().starts_with('-') ? "" : words.front();
  po::variables_map given;
  using namespace po::command_line_style;
  po::store(po::command_line_parser(std::vector<std::string>(words.begin() + (name.empty() ? 0 : 1), words.end()))
                .options(known_options())
                .positional({})  // lists belong to their options
                .style(allow_long | long_allow_adjacent | long_allow_next)
                .run(),
            given);
  if (name.empty() || given.count("help")) return print_help();
  const auto* command = std::ranges::find(commands, name, &Command::name);
  if (command == std::end(commands))
    throw BadOption(fmt::format("{}: unknown command; `delf-bench --help` lists them", name));
  const Request request = checked(given);
  print_machine();
  command->carry_out(request);
}

}  // namespace

int run(const std::vector<std::string>& words) {
  const auto refused = [](const std::exception& error, int code) {
    std::fflush(stdout);
    fmt::print(stderr, "delf-bench: {}\n", error.what());
    return code;
  };
  try {
    carry_out(words);
    return 0;
  } catch (const po::error& error) {
    return refused(error, 2);
  } catch (const BadOption& error) {
    return refused(error, 2);
  } catch (const BadInput& error) {
    return refused(error, 2);
  } catch (const NumericalFailure& error) {
    return refused(error, 3);
  } catch (const std::bad_alloc&) {
    return refused(std::runtime_error("out of memory: give fewer sites"), 4);
  }
}

}  // namespace delf::bench
