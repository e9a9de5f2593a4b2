// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/bench/pairing.hpp"

namespace delf::bench {

/// A table that is printed row by row as the numbers come: the first column to the left, the others to the right.
class Table {
 public:
  struct Column {
    std::string heading;
    std::size_t width;
  };
  explicit Table(std::vector<Column> columns);
  void row(const std::vector<std::string>& cells) const;

 private:
  std::vector<Column> columns_;
};

/// Three digits, as "1.83"
std::string number(double);
/// "12.1 (11.8 … 12.6)"
std::string in_words(const Spread&);

}  // namespace delf::bench
