#pragma once

namespace dem::domain {

/// Space without borders: grains go anywhere. The default.
struct Open {
  static constexpr bool has_images = false, has_ranks = false;
};

/// Whether the cells above and below go by: domain::Sheared.
template <class Domain>
concept IsSheared = requires(const Domain& domain) {
  domain.slip();
};

}  // namespace dem::domain
