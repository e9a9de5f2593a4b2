// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/results/sha256.hpp"

using delf::testing::Folder;

TEST_CASE("files are named with their SHA-256") {
  const Folder folder;
  folder.write("abc", "abc");
  folder.write("with blank", "");
  const auto sums = delf::sha256_of(folder.path(), {"abc", "with blank", "not there"});
  CHECK(sums.size() == 2);
  // FIPS 180-4, example B.1, and the empty message
  CHECK(sums.at("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sums.at("with blank") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}
