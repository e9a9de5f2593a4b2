// SPDX-License-Identifier: MIT
#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/scene/rows_table.hpp"
#include "tools/scene/scene.hpp"
#include "tools/verify/verify_request.hpp"

using namespace delf;
using delf::testing::Folder;

namespace {

// More of them by hand: DELF_MUTATIONS=1000 takes a thousand times as many, from other seeds with DELF_SEED.
int times(const char* variable, int usual) {
  const char* given = std::getenv(variable);
  return given ? std::atoi(given) : usual;
}

class Mutation {
 public:
  explicit Mutation(unsigned seed) : random_(seed) {}

  std::string of(std::string text) {
    for (int n = 1 + below(3); n > 0; --n) {
      const std::size_t at = place(text),
                        length = std::min<std::size_t>(text.size() - at, 1 + place(std::string(40, ' ')));
      switch (below(6)) {
        case 0:
          if (!text.empty() && at < text.size()) text[at] ^= static_cast<char>(1 << below(8));
          break;
        case 1:
          text.erase(at, length);
          break;
        case 2:
          text.insert(place(text), text.substr(at, length));
          break;
        case 3:
          text.resize(at);
          break;
        case 4:
          if (at < text.size()) text[at] = static_cast<char>(below(256));
          break;
        default:
          text.insert(at, words[static_cast<std::size_t>(below(static_cast<int>(words.size())))]);
      }
    }
    return text;
  }

 private:
  static constexpr std::array words{"1e999",      "-1", "0", "nan", "inf", "=", "[", "]", "\n", "#",  "1e-320",
                                    "2147483648", ",",  "x", ":",   "(",   "^", "*", "/", "'",  "\r", ";"};
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  std::size_t place(const std::string& text) { return random_() % (text.size() + 1); }
  std::mt19937 random_;
};

// Refused as bad input, or read; anything else, and more than five seconds, is a fault. The number that was refused.
int refused(int count, const std::string& whole, const std::function<void(const std::string&)>& reads) {
  reads(whole);  // it is read as it is
  Mutation mutation(static_cast<unsigned>(times("DELF_SEED", 1)));
  int refused = 0;
  for (int n = 0; n < count * times("DELF_MUTATIONS", 1); ++n) {
    const std::string text = mutation.of(whole);
    const auto begin = std::chrono::steady_clock::now();
    try {
      reads(text);
    } catch (const BadInput& bad) {
      ++refused;
      if (std::string(bad.what()).empty()) FAIL("refused without a word: " << text);
    } catch (const std::exception& other) {
      FAIL(other.what() << "\n" << text);
    }
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(5)) FAIL("too long:\n" << text);
  }
  return refused;
}

}  // namespace

TEST_CASE("scenes with wrong bytes are refused, or read") {
  const Folder folder;
  const auto scene = GENERATE(as<std::string>(), "kink", "kepler", "wave-map-text", "coupled-pendula");
  const std::string whole = delf::testing::read(std::string(DELF_SCENES_SOURCE "/") + scene + ".ini");
  CHECK(refused(60, whole, [&](const std::string& text) { read_scene(folder.write("scene.ini", text), {}); }) > 5);
}

TEST_CASE("rows with wrong bytes are refused, or read") {
  const Folder folder;
  std::string rows = "# rows of another program\nt,u1,u2,u3\n", table = "row,site,phi\n";
  for (int row = 0; row < 4; ++row) {
    rows += std::to_string(0.1 * row) + ",0.5,-1.25e-3,3\n";
    for (int site = 0; site < 3; ++site)
      table += std::to_string(row) + "," + std::to_string(site) + "," + std::to_string(0.3 * site) + "\n";
  }
  const auto all_of = [](const RowsFile& file) {
    for (int frame = 0; frame < file.frames(); ++frame) file.row(frame), file.time(frame);
  };
  CHECK(refused(150, rows,
                [&](const std::string& text) { all_of(*open_plain_rows(folder.write("a.csv", text), 3, 1)); }) > 20);
  CHECK(refused(150, table, [&](const std::string& text) { all_of(RowsTable(folder.write("b.csv", text))); }) > 20);
  std::string npy = "\x93NUMPY\x01";
  npy += '\0';
  std::string head = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }";
  head.resize(117, ' '), head += "\n";
  npy += static_cast<char>(head.size());
  npy += '\0';
  npy += head + std::string(4 * 3 * 8, '\x3f');
  std::string negative = npy;
  negative.replace(negative.find("(4, 3)"), 6, "(4,-3)");
  CHECK_THROWS_AS(open_plain_rows(folder.write("c.npy", negative), 3, 1), BadInput);
  CHECK(refused(150, npy,
                [&](const std::string& text) { all_of(*open_plain_rows(folder.write("c.npy", text), 3, 1)); }) > 20);
}

TEST_CASE("regions with wrong characters are refused, or read") {
  const std::filesystem::path scene = DELF_SCENES_SOURCE "/kink.ini";
  CHECK(refused(60, "0:8x10:30-3:5x18:22 hole", [&](const std::string& text) {
          if (text.find_first_of("#\n\r") != std::string::npos) return;
          read_verify_request(read_scene(scene, {{"verify.regions", text, 0}}));
        }) > 10);
}
