// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "lattice/error.hpp"

namespace delf {

/// The state that a restart needs. A class lists its state once, in visit(SavedState&), item by item with a name: the
/// same list saves the items and restores them, so that the two cannot disagree. Restoring reads into an object that
/// was built from the same scene, and checks every name and size.
class SavedState {
 public:
  virtual ~SavedState() = default;
  /// Items are read into what is visited; otherwise they are written.
  virtual bool restores() const = 0;

  /// A number, a flag, an enumerator, a struct of these, or a container of such items that can be resized.
  template <class T>
  void operator()(std::string_view name, T& item) {
    if constexpr (std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>) {
      begin(name, sizeof(T));
      transfer(&item, sizeof(T));
    } else {
      std::uint64_t size = item.size();
      (*this)(name, size);
      if (restores()) {
        if (size > most_items()) throw misfit(name);
        item.resize(size);
      }
      using Item = typename T::value_type;
      if constexpr (std::is_trivially_copyable_v<Item> && requires { item.data(); })
        numbers(name, item.data(), item.size());
      else
        for (Item& one : item) (*this)(name, one);
    }
  }
  /// Items of which both sides know how many there are.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void numbers(std::string_view name, T* items, std::size_t count) {
    begin(name, count * sizeof(T));
    transfer(items, count * sizeof(T));
  }

 protected:
  /// Writes the bytes, or reads so many.
  virtual void transfer(void* bytes, std::size_t count) = 0;
  /// No container that is restored has more items than there are bytes.
  virtual std::uint64_t most_items() const = 0;

 private:
  static BadInput misfit(std::string_view name) {
    return {"", "the saved state does not fit this run at \"" + std::string(name) + "\""};
  }
  /// Each item is preceded by a hash of its name (FNV-1a) and its size in bytes.
  void begin(std::string_view name, std::uint64_t bytes) {
    std::uint64_t hash = 14695981039346656037U;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
    std::uint64_t head[2] = {hash, bytes};
    const std::uint64_t wanted[2] = {hash, bytes};
    transfer(head, sizeof head);
    if (restores() && (head[0] != wanted[0] || head[1] != wanted[1])) throw misfit(name);
  }
};

}  // namespace delf
