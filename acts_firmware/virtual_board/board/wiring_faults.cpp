// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "board/wiring_faults.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

namespace acts {

namespace {

constexpr int kHighestLine = kMaxSide - 1;
constexpr int kHighestAddressBit = 5;

struct Kind {
  const char* name;
  const char* values;
  std::vector<int> highest;  // of each value
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {{"open-row", "R", {kHighestLine}},
                                           {"open-col", "C", {kHighestLine}},
                                           {"short-rows", "R,R", {kHighestLine, kHighestLine}},
                                           {"short-cols", "C,C", {kHighestLine, kHighestLine}},
                                           {"dead", "R,C", {kHighestLine, kHighestLine}},
                                           {"stuck", "R,C,COUNTS", {kHighestLine, kHighestLine, kCountMax}},
                                           {"address-bit", "B", {kHighestAddressBit}}};
  return kKinds;
}

[[noreturn]] void refuse(const std::string& words) {
  std::string allowed;
  for (const Kind& kind : kinds()) {
    allowed += (allowed.empty() ? "" : ", ") + std::string(kind.name) + "=" + kind.values;
  }
  throw std::invalid_argument(words + ": allowed is one of " + allowed + " with R and C from 0 to " +
                              std::to_string(kHighestLine) + ", two lines of a short unlike, COUNTS to " +
                              std::to_string(kCountMax) + ", B to " + std::to_string(kHighestAddressBit));
}

std::vector<int> numbers(const std::string& words, const std::string& text, const std::vector<int>& highest) {
  std::vector<int> values;
  const char* position = text.c_str();
  for (std::size_t i = 0; i < highest.size(); ++i) {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(position, &end, 10);
    const char after = i + 1 < highest.size() ? ',' : '\0';
    if (end == position || *end != after || errno != 0 || value < 0 || value > highest[i]) {
      refuse(words);
    }
    values.push_back(static_cast<int>(value));
    position = end + 1;
  }
  return values;
}

std::uint64_t bit(int line) {
  return std::uint64_t{1} << line;
}

}  // namespace

WiringFaults::WiringFaults() {
  for (int line = 0; line < kMaxSide; ++line) {
    row_groups_[static_cast<std::size_t>(line)] = col_groups_[static_cast<std::size_t>(line)] = bit(line);
  }
}

void WiringFaults::add(const std::string& words) {
  const std::size_t equals = words.find('=');
  const std::string name = words.substr(0, equals);
  const auto kind = std::find_if(kinds().begin(), kinds().end(), [&name](const Kind& k) { return name == k.name; });
  if (equals == std::string::npos || kind == kinds().end()) {
    refuse(words);
  }
  const std::vector<int> values = numbers(words, words.substr(equals + 1), kind->highest);
  Fault fault{words};
  if (name == "open-row") {
    open_rows_ |= bit(values[0]);
    fault.highest_row = values[0];
  } else if (name == "open-col") {
    open_cols_ |= bit(values[0]);
    fault.highest_col = values[0];
  } else if (name == "address-bit") {
    broken_address_ |= 1U << values[0];
    fault.address_bit = values[0];
  } else if (name == "dead" || name == "stuck") {
    fixed_.push_back({values[0], values[1], name == "stuck" ? values[2] : 0.0});
    fault.highest_row = values[0];
    fault.highest_col = values[1];
  } else {
    if (values[0] == values[1]) {
      refuse(words);
    }
    const bool rows = name == "short-rows";
    join(rows ? row_groups_ : col_groups_, values[0], values[1]);
    (rows ? fault.highest_row : fault.highest_col) = std::max(values[0], values[1]);
  }
  faults_.push_back(fault);
}

void WiringFaults::check(int rows, int cols) const {
  for (const Fault& fault : faults_) {
    if (fault.highest_row >= rows || fault.highest_col >= cols) {
      throw std::invalid_argument(fault.words + ": an array of " + std::to_string(rows) + " x " + std::to_string(cols) +
                                  " has the rows 0 to " + std::to_string(rows - 1) + " and the columns 0 to " +
                                  std::to_string(cols - 1));
    }
    if (fault.address_bit >= 0 && cols <= 1 << fault.address_bit) {
      throw std::invalid_argument(fault.words + ": none of " + std::to_string(cols) + " columns has this bit set");
    }
  }
}

std::uint64_t WiringFaults::energised(std::uint64_t driven) const {
  std::uint64_t rows = 0;
  for (int row = 0; row < kMaxSide && driven >> row != 0; ++row) {
    if ((driven >> row & 1U) != 0) {
      rows |= row_groups_[static_cast<std::size_t>(row)];
    }
  }
  return rows & ~open_rows_;
}

std::uint64_t WiringFaults::connected(unsigned column) const {
  return column < kMaxSide ? col_groups_[column] & ~open_cols_ : 0;
}

std::optional<double> WiringFaults::fixed_counts(int row, int col) const {
  for (const FixedTaxel& taxel : fixed_) {
    if (taxel.row == row && taxel.col == col) {
      return taxel.counts;
    }
  }
  return std::nullopt;
}

void WiringFaults::join(Groups& groups, int first, int second) {
  const std::uint64_t together = groups[static_cast<std::size_t>(first)] | groups[static_cast<std::size_t>(second)];
  for (int line = 0; line < kMaxSide; ++line) {
    if ((together >> line & 1U) != 0) {
      groups[static_cast<std::size_t>(line)] = together;
    }
  }
}

}  // namespace acts
