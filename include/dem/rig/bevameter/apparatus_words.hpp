#pragma once
// What the apparatus of a bevameter say, in the words of its own options.

#include <dem/core/error.hpp>
#include <dem/rig/own_words.hpp>
#include <dem/rig/stages.hpp>

#include <span>

namespace dem::rig::bevameter {

/// What the apparatus call otherwise than the bevameter, each for its own.
inline constexpr OwnWord plate_words[] = {{"--speed", "--plate-speed"},
                                          {"lower --threshold or --sinkage", "lower --sinkage"}};
inline constexpr OwnWord shear_words[] = {
    {"--travel", "--shear-travel"},
    {"--smoothing", "--shear-smoothing"},
    {"--relative-density, --densify-time or --seed", "--relative-density or --seed"},
    {"raise --consolidation-limit, --rest-speed or --damping", "raise --damping"},
    {"raise --settle-limit or --damping", "raise --damping"},
    {"; take more --grains or a smaller --half-edge if that matters", ""},
    {"take more --grains or a smaller --half-edge, or let", "let"}};
inline constexpr OwnWord wheel_words[] = {
    {"--width (m, within the bed)", "width of the wheel (m, within --wheel-bed-width)"},
    {"raise --stage-limit or --set-down-speed", "raise --stage-limit"},
    {"--bed-length", "--wheel-bed-length"},
    {"--travel", "--wheel-travel"},
    {"--bed-width", "--wheel-bed-width"},
    {"--bed-depth", "--wheel-bed-depth"}};

/// Calls what an apparatus does. What it throws is said in the bevameter's words.
template <class F>
auto in_words(std::span<const OwnWord> words, F&& act) {
  try {
    return act();
  } catch (const Error& problem) {
    throw Error(in_own_words(problem.what(), words));
  } catch (const Stopped& problem) {
    throw Stopped(in_own_words(problem.what(), words));
  }
}

}  // namespace dem::rig::bevameter
