// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Sizes that everything on the board is made for; nothing is allocated after construction.
#pragma once

#include <cstddef>
#include <cstdint>

namespace acts {

constexpr int kMaxSide = 64;                     // rows or columns
constexpr int kMaxTaxels = kMaxSide * kMaxSide;  // of an array
constexpr int kCountMax = 1023;                  // 10 bit ADC

}  // namespace acts
