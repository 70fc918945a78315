// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// All a sketch needs. The Arduino builder finds this library by this header's name.
#pragma once

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/board/pacer.hpp"
#include "acts_firmware/board/wiring.hpp"
#include "acts_firmware/firmware.hpp"
