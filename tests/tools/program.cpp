// SPDX-License-Identifier: MIT
#include "tests/tools/program.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace delf::testing {

namespace fs = std::filesystem;

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "delf-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no folder for the test: " + name);
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return (path_ / name).string();
}

Ran shell(const Folder& folder, const std::string& line) {
  const std::string script = folder.write(".command", line + "\n");
  const std::string command = "cd '" + folder.path().string() + "' && sh '" + script + "' > .out 2> .err < /dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(folder / ".out"), read(folder / ".err")};
}

std::string program_path() { return DELF_PROGRAM; }
std::string scenes_folder() { return DELF_SCENES_SOURCE; }

Ran delf_program(const Folder& folder, const std::string& arguments, const std::string& before) {
  return shell(folder, before + " '" + program_path() + "' " + arguments);
}

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string complaints(const Ran& ran) {
  static const std::regex progress("[0-9]+ %: \\w+ [0-9]+ of [0-9]+ after .* left");
  std::string all;
  for (const std::string& line : lines(ran.err))
    if (!std::regex_match(line, progress)) all += line + "\n";
  return all;
}

std::string small_scene(const std::string& more) {
  return "[theory]\nname = sine-gordon\n[lattice]\nlength = 20\nsites = 64\ncourant = 0.5\n"
         "[initial]\nstate = breather\n[run]\nsteps = 100\n[output]\nfigures = off\n" +
         more;
}

}  // namespace delf::testing
