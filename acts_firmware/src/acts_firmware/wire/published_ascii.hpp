// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The stream of the authors' published raster sketch.
#pragma once

#include <cstddef>
#include <cstdint>

#include "acts_firmware/frame.hpp"

namespace acts {

// Four digits and a comma a taxel, ten digits of time, CR LF.
constexpr std::size_t kMaxAsciiBytes = 5 * kMaxTaxels + 12;

// All values row by row, each followed by ',', then the scan's duration [us] and CR LF; of a raster frame. `out` has
// room for kMaxAsciiBytes. Returns the number of bytes.
std::size_t encode_raster_line(const SampleFrame& frame, std::uint8_t* out);

}  // namespace acts
