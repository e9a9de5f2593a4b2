// SPDX-License-Identifier: MIT
#include <zlib.h>

#include <cstdint>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/plain_rows.hpp"

using namespace delf::testing;

namespace {

// As numpy.save writes it.
template <class Number>
std::string npy(const std::string& shape, const std::string& type, const std::vector<Number>& values) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(117, ' ');
  header += '\n';
  const auto* bytes = reinterpret_cast<const char*>(values.data());
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + std::string(bytes, values.size() * sizeof(Number));
}

std::string bytes(std::size_t value, int count) {
  std::string text;
  for (int n = 0; n < count; ++n) text += static_cast<char>(value >> (8 * n) & 0xff);
  return text;
}

std::string deflated(const std::string& data) {
  std::string packed(2 * data.size() + 64, '\0');
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// As numpy.savez writes it (method 0), or numpy.savez_compressed (8), with the fields of a ZIP archive that count.
std::string npz(const std::vector<std::pair<std::string, std::string>>& files, std::size_t method = 0) {
  std::string all, directory;
  for (const auto& [name, whole] : files) {
    const std::string data = method == 8 ? deflated(whole) : whole;
    directory += "PK\1\2" + std::string(6, '\0') + bytes(method, 2) + std::string(8, '\0') + bytes(data.size(), 4) +
                 bytes(whole.size(), 4) + bytes(name.size(), 2) + std::string(12, '\0') + bytes(all.size(), 4) + name;
    all += "PK\3\4" + std::string(22, '\0') + bytes(name.size(), 2) + bytes(3, 2) + name + "abc" + data;
  }
  return all + directory + "PK\5\6" + std::string(6, '\0') + bytes(files.size(), 2) + std::string(4, '\0') +
         bytes(all.size(), 4) + std::string(2, '\0');
}

}  // namespace

TEST_CASE("momenta are read beside the fields") {
  const Folder folder;
  const auto q = npy<double>("(3, 2)", "<f8", {0, 1, 10, 11, 20, 21}),
             p = npy<double>("(3, 2)", "<f8", {5, 6, 7, 8, 9, 10}), t = npy<double>("(3,)", "<f8", {0, 0.5, 1}),
             other = npy<double>("(2,)", "<f8", {1, 2});
  struct Case {
    std::string name, text;
    bool momenta = true, times = true;
  };
  for (const Case& c : std::vector<Case>{
           {"a.csv", "t,q1,q2,p1,p2\n0,0,1,5,6\n0.5,10,11,7,8\n1,20,21,9,10\n"},
           {"b.csv", "t,p1,q1,p2,q2\n0,5,0,6,1\n0.5,7,10,8,11\n1,9,20,10,21\n"},
           {"c.npz", npz({{"q.npy", q}, {"p.npy", p}, {"t.npy", t}})},
           {"c8.npz", npz({{"q.npy", q}, {"p.npy", p}, {"t.npy", t}}, 8)},
           {"d.npz", npz({{"phi.npy", q}, {"pi.npy", p}}), true, false},
           {"e.npz", npz({{"anything.npy", q}}), false, false},
           {"f.npz", npz({{"q.npy", q}, {"p.npy", other}}), false, false},  // of another shape
       }) {
    INFO(c.name);
    const auto rows = delf::open_plain_rows(folder.write(c.name, c.text), 1, 2);
    REQUIRE(rows->frames() == 3);
    CHECK(rows->row(1) == std::vector<double>{10, 11});
    REQUIRE(rows->momenta(1).has_value() == c.momenta);
    if (c.momenta) CHECK(*rows->momenta(1) == std::vector<double>{7, 8});
    CHECK(rows->time(1).has_value() == c.times);
  }
  folder.write("g.npz", npz({{"a.npy", q}, {"b.npy", p}}));
  CHECK(delf::open_plain_rows(folder / "g.npz:/b", 1, 2)->row(0) == std::vector<double>{5, 6});
  const auto refused = [&](const std::string& text) -> std::string {
    try {
      delf::open_plain_rows(folder.write("h.npz", text), 1, 2);
      return {};
    } catch (const delf::BadInput& bad) {
      return bad.what();
    }
  };
  CHECK(contains(refused(npz({{"a.npy", q}, {"b.npy", p}})), "has the arrays a, b; name the one"));
  CHECK(contains(refused(npz({{"q.npy", q}}, 14)), "is compressed in a way that zlib does not know"));
  std::string damaged = npz({{"q.npy", q}}, 8);
  damaged[38] = '\xff';  // behind the names: a block of no kind
  CHECK(contains(refused(damaged), "is damaged; write it by numpy.savez"));
  CHECK(contains(refused("PK"), "is no .npz file"));
}

TEST_CASE("plain arrays are read as rows, whichever way they lie") {
  const Folder folder;
  struct Case {
    std::string name, text;
    bool times = false;
  };
  // three rows of two sites: 0 1, 10 11, 20 21
  for (const Case& c : std::vector<Case>{
           {"a.txt", "0 1\n10 11\n20 21\n"},
           {"b.csv", "# of a program\nu0,u1\n0,1\n10,11\n20,21\n"},
           {"c.csv", "t,u0,u1\n0,0,1\n0.5,10,11\n1,20,21\n", true},
           {"d.dat", "0.0;0;1\n0.5;10;11\n1.0;20;21\n", true},
           {"e.txt", "0 10 20\r\n1 11 21\r\n"},
           {"f.csv", "row,site,phi\n0,0,0\n0,1,1\n1,0,10\n1,1,11\n2,0,20\n2,1,21\n"},
           {"g.npy", npy<double>("(3, 2)", "<f8", {0, 1, 10, 11, 20, 21})},
           {"h.npy", npy<float>("(3, 2, 1)", "<f4", {0, 1, 10, 11, 20, 21})},
           {"i.npy", npy<double>("(2, 3)", "<f8", {0, 10, 20, 1, 11, 21})},
       }) {
    INFO(c.name);
    const auto rows = delf::open_plain_rows(folder.write(c.name, c.text), 2, 1);
    REQUIRE(rows);
    REQUIRE(rows->frames() == 3);
    for (int j = 0; j < 3; ++j) CHECK(rows->row(j) == std::vector<double>{10.0 * j, 10.0 * j + 1});
    CHECK(rows->time(1).has_value() == c.times);
    if (c.times) CHECK(*rows->time(1) == 0.5);
  }
  const auto point = delf::open_plain_rows(folder.write("q.npy", npy<double>("(3,)", "<f8", {1, 2, 3})), 1, 1);
  REQUIRE(point->frames() == 3);
  CHECK(point->row(1) == std::vector<double>{2});
  CHECK_FALSE(delf::open_plain_rows(folder.write("fields.h5", ""), 2, 1));
}

TEST_CASE("plain arrays of another shape are refused") {
  const Folder folder;
  const auto refused = [&](const std::string& name, const std::string& text, const std::string& why) {
    INFO(name);
    try {
      delf::open_plain_rows(folder.write(name, text), 2, 1);
      FAIL("nothing was found wrong");
    } catch (const delf::BadInput& bad) {
      INFO(bad.what());
      CHECK(contains(bad.what(), why));
    }
  };
  refused("a.txt", "0 1 2 3\n0 1 2 3\n0 1 2 3\n", "holds 3 x 4 numbers, and a row of the scheme has 2");
  refused("b.txt", "0 1\n0\n", "line 2 has 1 columns, and others have 2");
  refused("c.csv", "0,1\n0,one\n", "line 2: \"one\" is no number");
  refused("d.csv", "t,u\n", "holds no numbers");
  refused("e.npy", "NUMPY", "is no .npy file");
  refused("f.npy", npy<double>("(9, 2)", "<f8", {0, 1}), "is cut short");
  refused("g.npy", npy<std::int64_t>("(1, 2)", "<i8", {0, 1}), "is not of float64 or float32");
}

TEST_CASE("verify reads a table, a data set of any name, and compares positions") {
  const Folder folder;
  folder.write("small.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nstencil = leapfrog\nlength = 20\nsites = 16\ntime_step = 0.5\n"
               "[initial]\nstate = breather\n[run]\nsteps = 12\n[output]\nfigures = off\nevery = 1\n");
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  const delf::FieldsReader rows(folder / "run/fields.h5");
  std::string table = "t";
  for (int i = 0; i < 16; ++i) table += ",u" + std::to_string(i);
  for (int j = 0; j < rows.frames(); ++j) {
    char number[40];
    std::snprintf(number, sizeof number, "\n%.17g", *rows.time(j));
    table += number;
    for (const double y : rows.row(j)) std::snprintf(number, sizeof number, ",%.17g", y), table += number;
  }
  folder.write("rows.csv", table + "\n");
  CHECK(delf_program(folder, "verify small.ini --fields rows.csv --out a").code == 0);
  CHECK(delf_program(folder, "verify small.ini --fields run/fields.h5 --dataset field --out b").code == 0);
  check_refused(delf_program(folder, "verify small.ini --fields rows.csv --lattice.time_step=0.25 --out c"),
                {"--fields rows.csv: frames 0 and 1 are 0.5 apart"});
  check_refused(delf_program(folder, "verify small.ini --fields run/fields.h5 --dataset u --out c"),
                {"has no dataset /u; name another by --dataset"});
  check_refused(delf_program(folder, "verify small.ini --dataset u --out c"), {"--dataset: of which file?"});
  check_refused(delf_program(folder, "verify small.ini --fields run/fields.h5 --lattice.length=40 --out c"),
                {"has sites 1.25 apart in /space, and the lattice has 2.5; use lattice.length = 20"});
}
