// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// From image row and column to pins and one conversion.
#pragma once

#include <cstdint>

#include "acts_firmware/board/board.hpp"
#include "acts_firmware/board/wiring.hpp"

namespace acts {

// Measures one taxel. The sampling schemes know no more of the hardware than this.
class TaxelReader {
 public:
  TaxelReader() = default;
  TaxelReader(const TaxelReader&) = delete;
  TaxelReader& operator=(const TaxelReader&) = delete;
  virtual ~TaxelReader() = default;

  virtual std::uint16_t measure(int row, int col) = 0;
};

// Row line, then multiplexer, then ADC. Exactly one row line is high at a time; pins that keep their level are not
// written again.
class Scanner final : public TaxelReader {
 public:
  // All row lines low, multiplexer on column 0.
  Scanner(Board& board, const Wiring& wiring);

  std::uint16_t measure(int row, int col) override;

 private:
  Board& board_;
  Wiring wiring_;
  int row_ = -1;
  int col_ = 0;
};

}  // namespace acts
