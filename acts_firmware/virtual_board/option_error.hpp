// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What the command line gives and the board cannot work with, however often it is started: exit code 2.
#pragma once

#include <stdexcept>

namespace acts {

// What was given, what is allowed.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace acts
