// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The sketch as the Arduino builder compiles it: C++ after Arduino.h.
#include <Arduino.h>

#include "../examples/teensy41/teensy41.ino"
