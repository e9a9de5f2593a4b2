// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace delf {

/// How the expected value of a result is known: its source prints it, draws it only, or has none, and it is derived.
inline const std::vector<std::string> kinds_of_results{"printed", "drawn", "derived"};

/// A published number or equation, and the command that computes it here. Members are keys of a file of results, as
/// tools/reproduce/README.md has them.
struct PublishedResult {
  std::string id, title;
  std::string paper, reference, doi, where;  ///< paper: the file's name; where: a figure, an equation, a section
  std::string command, keys, scene;          ///< SCENE in the command is the text `scene`
  std::string number;                        ///< a formula of numbers in the results of the command, or `equation`
  std::string kind, expected;                ///< one of kinds_of_results, and the value under that key
  std::string correct;                       ///< in place of a misprint
  std::string tolerance, because, differs, checked;
  bool slow = false;
  std::filesystem::path file;
  int line = 0;

  /// "FILE:LINE: ID"
  std::string place() const;
};

/// The results of all papers, those of a paper together, in the order of its file. Throws BadScene, with file and line, for
/// what is none.
std::vector<PublishedResult> published_results();

/// Those of the ids, or of the papers, that are named; without names all, as `slow` says: off, on or only. Throws BadScene,
/// with the nearest name, for one that is unknown.
std::vector<PublishedResult> chosen_results(const std::vector<std::string>& names, const std::string& slow);

}  // namespace delf
