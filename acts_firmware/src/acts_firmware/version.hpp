// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The firmware's release, as replies report it. package.xml says the same; a test compares the two.
#pragma once

#include <cstdint>

namespace acts {

constexpr std::uint8_t kVersionMajor = 0;
constexpr std::uint8_t kVersionMinor = 1;
constexpr std::uint8_t kVersionPatch = 0;

}  // namespace acts
