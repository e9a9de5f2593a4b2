// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

namespace delf {

/// The kinds of space that keys tell apart. The last three are lattice.space = complex: a mesh whose field goes on in time,
/// one whose field is at rest, and a finite complex of spacetime.
enum class SpaceKind { circle, interval, point, mesh, still, spacetime };

/// Why a space of this kind does not read a key of the program's table; empty if it does.
std::string why_unread(SpaceKind, std::string_view key);
/// Why it reads no key of time; empty if it does.
std::string why_without_time(SpaceKind);

}  // namespace delf
