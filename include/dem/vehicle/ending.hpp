#pragma once

namespace dem::vehicle::ending {

/// How a drive ended, in a word for a table.
inline constexpr const char* arrived = "arrived";  ///< at the end of the path
inline constexpr const char* stopped = "stopped";  ///< by its brakes, or coasting
inline constexpr const char* dug_in = "dug in";    ///< its wheels spin on the spot, or one is as deep as its radius
inline constexpr const char* rolled_over = "rolled over";    ///< roll or pitch beyond 60 deg
inline constexpr const char* left_lane = "left the lane";    ///< a wheel's middle is beyond the side of its ground
inline constexpr const char* slid_back = "slid back";        ///< 0.3 m behind the start
inline constexpr const char* too_slow = "too slow";          ///< not there in four times the path's time and 3 s
inline constexpr const char* inputs_ended = "inputs ended";  ///< the last row of a table of inputs was driven
inline constexpr const char* held = "held";                  ///< by a load cell, over all slips that were asked for

}  // namespace dem::vehicle::ending
