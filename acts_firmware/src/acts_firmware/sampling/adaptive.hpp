// Adaptive sampling: from coarse to fine, and around what is pressed first.
#pragma once

#include <array>
#include <cstdint>

#include "acts_firmware/sampling/config.hpp"
#include "acts_firmware/sampling/division_order.hpp"
#include "acts_firmware/sampling/measurement.hpp"
#include "acts_firmware/sampling/skin_map.hpp"

namespace acts {

// Paper, Supplemental Algorithm 1, with the two points in which the published firmware differs from it: exactly m
// taxels are measured, and the threshold itself does not count as a touch. Order and neighbours are those of the skin.
class Adaptive {
 public:
  // Measures until the frame has m taxels.
  void sample(const SamplingConfig& config, const SkinMap& map, const DivisionOrder& order, int m, Measurement& frame);

 private:
  struct Visit {
    std::uint16_t place;
    std::uint8_t next;  // which neighbour comes next
  };

  bool is_pressed(const SamplingConfig& config, const SkinMap& map, int place, Measurement& frame);
  void search(const SamplingConfig& config, const SkinMap& map, int pressed, int m, Measurement& frame);

  // Instead of recursion: a palm on the skin is a thousand levels deep.
  std::array<Visit, kMaxTaxels> stack_{};
};

}  // namespace acts
