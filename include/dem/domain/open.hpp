#pragma once

namespace dem::domain {

/// Space without borders: grains go anywhere. The default.
struct Open {
  static constexpr bool has_images = false, has_ranks = false;
};

}  // namespace dem::domain
