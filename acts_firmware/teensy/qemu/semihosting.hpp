// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What a program under QEMU asks of the host: arguments, files, the end (Arm's semihosting interface).
#pragma once

namespace acts {

struct Arguments {
  int count;
  char** values;
};
Arguments command_line();

// For where not even printf can be trusted.
[[noreturn]] void say_and_stop(const char* text);

}  // namespace acts
