#pragma once

#include <dem/grain/contact_wrench.hpp>
#include <dem/grain/partner_view.hpp>
#include <dem/math/quads.hpp>

namespace dem::grain {

/// Pairs of partners, one for each lane.
struct PartnerLanes {
  const PartnerView *i[pack_width], *j[pack_width];

  void set(int lane, const PartnerView& a, const PartnerView& b) {
    i[lane] = &a;
    j[lane] = &b;
  }
};

/// From i to j, and in the last place the sum of the radii.
DEM_HOT_HOST std::array<Pack, 4> separations(const PartnerLanes& p) {
  return packs(difference_and_sum(load_quads([&](int lane) { return p.j[lane]->row(0); }),
                                  load_quads([&](int lane) { return p.i[lane]->row(0); })));
}

DEM_HOT_HOST RelativeMotion<Pack> relative_motions(const PartnerLanes& p) {
  const auto x = separations(p);
  const auto v = packs(difference_and_sum(load_quads([&](int lane) { return p.j[lane]->row(1); }),
                                          load_quads([&](int lane) { return p.i[lane]->row(1); })));
  const auto a = packs(load_quads([&](int lane) { return p.i[lane]->row(2); }));
  const auto b = packs(load_quads([&](int lane) { return p.j[lane]->row(2); }));
  return {{x[0], x[1], x[2]}, {-v[0], -v[1], -v[2]}, {a[0], a[1], a[2]}, {b[0], b[1], b[2]}, v[3]};
}

}  // namespace dem::grain
