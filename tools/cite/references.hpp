// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <string>
#include <vector>

namespace delf {

/// A publication that entries of theories, methods, states, stencils, splittings, tableaux and peers name by its key.
struct CitedWork {
  std::string key;
  std::string type;    ///< "article"
  std::string bibtex;  ///< the whole entry
  std::map<std::string, std::string> fields;

  std::string field(const std::string& name) const;  ///< empty if there is none
  bool is_checked() const;                           ///< against a record of its DOI, or another list of references
};

/// The entries of references.bib, and delf itself, of CITATION.cff.
const std::vector<CitedWork>& references();
/// Null if there is none of that key.
const CitedWork* find_reference(const std::string& key);
/// "J. C. Butcher, Implicit Runge–Kutta processes, Mathematics of Computation 18 (1964) 50–64, doi:10.1090/…"
std::string in_words(const CitedWork&);

}  // namespace delf
