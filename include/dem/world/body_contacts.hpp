#pragma once

// Which surfaces of machine parts may touch each other (WorldSetup::add_body_contact).

#include <dem/core/known.hpp>
#include <dem/world/check.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace dem::detail {

/// No force between them can move either.
inline bool are_fixed_for_good(const Body& a, const Body& b) { return a.is_fixed_for_good() && b.is_fixed_for_good(); }

/// Lets two surfaces touch each other when the world is next prepared. Throws Error for surfaces of one body, of two
/// fixed bodies without mass, or that both have no points.
template <class Model>
BodyContactId add_body_contact(WorldState<Model>& w, SurfaceId a, SurfaceId b) {
  const auto &sa = known(w.surfaces, a, "surface"), &sb = known(w.surfaces, b, "surface");
  const Body &body_a = w.machine.body(sa.body), &body_b = w.machine.body(sb.body);
  if (sa.body == sb.body) {
    fail("{} and {} belong to the same body and cannot touch each other", surface_in_words(w, a.index()),
         surface_in_words(w, b.index()));
  }
  if (are_fixed_for_good(body_a, body_b)) {
    fail("body '{}' and body '{}' are both fixed for good, so no force between them would move anything", body_a.name,
         body_b.name);
  }
  if (!coupling::has_points(sa) && !coupling::has_points(sb)) {
    fail("neither {} nor {} has points that could touch the other (planes have none)", surface_in_words(w, a.index()),
         surface_in_words(w, b.index()));
  }
  if (w.body_contacts.pairs.size() >= coupling::BodyKey::most_pairs) {
    fail("a world takes at most {} pairs of surfaces that may touch", coupling::BodyKey::most_pairs);
  }
  w.body_contacts.pairs.push_back({a, b});
  w.find_body_contacts = [](WorldState<Model>& s) {
    coupling::find_body_contacts<Model>(s.body_contacts, std::span(std::as_const(s.surfaces)), s.materials,
                                        std::span(s.machine.bodies()), s.time_step);
  };
  return BodyContactId(w.body_contacts.pairs.size() - 1);
}

/// Lets all surfaces touch each other, but those that cannot, that a joint joins, or that may already. Returns how many
/// pairs were added.
template <class Model>
std::size_t add_body_contacts(WorldState<Model>& w) {
  const auto both = [](std::size_t a, std::size_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
  std::vector<std::pair<std::size_t, std::size_t>> joined, known_pairs;
  for (const auto& joint : w.machine.parts().joints) {
    if (joint.kind != mbd::JointKind::free) joined.push_back(both(joint.a, joint.b));
  }
  for (const auto& pair : w.body_contacts.pairs) known_pairs.push_back(both(pair.a.index(), pair.b.index()));
  for (auto* list : {&joined, &known_pairs}) std::sort(list->begin(), list->end());
  const auto holds = [](const auto& list, const auto& pair) {
    return std::binary_search(list.begin(), list.end(), pair);
  };
  const std::size_t before = w.body_contacts.pairs.size();
  for (std::size_t a = 0; a < w.surfaces.size(); ++a) {
    for (std::size_t b = a + 1; b < w.surfaces.size(); ++b) {
      const BodyId i = w.surfaces[a].body, j = w.surfaces[b].body;
      const bool skip = i == j || are_fixed_for_good(w.machine.body(i), w.machine.body(j)) ||
                        (!coupling::has_points(w.surfaces[a]) && !coupling::has_points(w.surfaces[b])) ||
                        holds(joined, both(i.index(), j.index())) || holds(known_pairs, both(a, b));
      if (!skip) add_body_contact(w, SurfaceId(a), SurfaceId(b));
    }
  }
  return w.body_contacts.pairs.size() - before;
}

}  // namespace dem::detail
