// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// Random numbers that are the same on every machine, in Python too (acts_core.sampling.basis.pcg32).
#pragma once

#include <cstdint>

namespace acts {

// PCG-XSH-RR 64/32 (M. E. O'Neill, HMC-CS-2014-0905).
class Pcg32 {
 public:
  Pcg32(std::uint64_t seed, std::uint64_t stream) : increment_(stream << 1U | 1U) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t state = state_;
    state_ = state * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>((state >> 18U ^ state) >> 27U);
    const auto rotation = static_cast<std::uint32_t>(state >> 59U);
    return shifted >> rotation | shifted << (-rotation & 31U);
  }

  // 0 to bound - 1, every one equally likely (D. Lemire, doi:10.1145/3230636); bound is not 0.
  std::uint32_t below(std::uint32_t bound) {
    std::uint64_t product = std::uint64_t{next()} * bound;
    if (static_cast<std::uint32_t>(product) < bound) {
      const std::uint32_t unfair = (0U - bound) % bound;
      while (static_cast<std::uint32_t>(product) < unfair)
        product = std::uint64_t{next()} * bound;
    }
    return static_cast<std::uint32_t>(product >> 32U);
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace acts
