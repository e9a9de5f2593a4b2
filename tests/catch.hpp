// SPDX-License-Identifier: MIT
#pragma once

// Catch2 of either major version; `Catch::Approx` and plain `Approx` work under both.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
namespace Catch {
using Detail::Approx;
}
#endif
