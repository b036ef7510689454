#pragma once

#include <dem/flat/bits.hpp>
#include <dem/flat/contact_result.hpp>
#include <dem/flat/grains_view.hpp>
#include <dem/geometry/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace dem::flat {

/// Which of the possible contacts of a pair there are, a bit each. A shape may leave bits out between them.
template <class Shape>
using ContactBits = std::conditional_t<Shape::most_contacts == 1, std::uint8_t, std::uint64_t>;

/// The contacts of all candidates in one step: in the order of the candidates, and those of a pair ascending.
template <class Model>
struct PairContactsView {
  ContactBits<typename Model::Shape>* bits;  ///< of each candidate
  std::uint32_t* first;                      ///< contact of each candidate, and one more
  HistoriesView histories;
};

/// The candidates: pairs of grains that are close enough to be looked at.
struct CandidatesView {
  const std::uint32_t *owner, *partner;  ///< rows
};

/// Up to which gap grains may act on each other: nothing where cohesion does not act at a distance.
template <class Model>
using Gap = std::conditional_t<cohesion::reaches<typename Model::Cohesion>, double, shape::NoGap>;

/// One thread a candidate: which of its contacts there are.
template <class Model>
struct FindContactBits {
  using Shape = typename Model::Shape;
  GrainsView<Model> grains;
  CandidatesView candidates;
  Gap<Model> gap;
  ContactBits<Shape>* bits;

  DEM_FN void operator()(std::size_t k) const {
    const std::size_t i = candidates.owner[k], j = candidates.partner[k];
    const SpherePlace a = sphere(i), b = sphere(j);
    const Vector3<double> separation = b.position - a.position;
    const double reach = shape::widened(a.radius + b.radius, gap);
    std::uint64_t found = 0;
    if (dot(separation, separation) < reach * reach) found = bits_of_close(i, j, separation);
    bits[k] = static_cast<ContactBits<Shape>>(found);
  }

 private:
  /// The first row of a PartnerView.
  struct alignas(16) SpherePlace {
    Vector3<double> position;
    double radius;
  };
  DEM_FN SpherePlace sphere(std::size_t i) const {
    return load_wide(reinterpret_cast<const SpherePlace*>(grains.view + i));
  }
  DEM_FN std::uint64_t bits_of_close(std::size_t i, std::size_t j, const Vector3<double>& separation) const {
    if constexpr (!Shape::has_orientation) {  // a sphere is its own bounding sphere
      return 1;
    } else {
      const Pose<Shape> a = grains.pose_of(i), b = grains.pose_of(j);
      if constexpr (std::is_same_v<Gap<Model>, shape::NoGap>) {
        return Shape::contact_bits(grains.shape_of(i), a.number, grains.shape_of(j), b.number, separation);
      } else {
        return Shape::contact_bits(grains.shape_of(i), a.number, grains.shape_of(j), b.number, separation, gap);
      }
    }
  }
};

/// How many contacts a candidate has.
template <class Bits>
struct CountContactBits {
  const Bits* bits;
  DEM_FN std::uint32_t operator()(std::size_t k) const { return count_bits(bits[k]); }
};

/// Where a contact stands: its candidate, and its bit.
struct PairContactPlaces {
  std::uint32_t* candidate;
  std::uint8_t* bit;
};

/// One thread a candidate: writes down where its contacts stand.
template <class Bits>
struct ListPairContacts {
  const Bits* bits;
  const std::uint32_t* first;
  PairContactPlaces places;

  DEM_FN void operator()(std::size_t k) const {
    std::uint32_t c = first[k];
    for (std::uint64_t left = bits[k]; left != 0; left &= left - 1, ++c) {
      places.candidate[c] = static_cast<std::uint32_t>(k);
      places.bit[c] = static_cast<std::uint8_t>(lowest_bit(left));
    }
  }
};

/// One thread a contact: the laws. Its history of the evaluation before is found by the bits of the same candidate
/// then.
template <class Model>
struct EvaluatePairContacts {
  using Shape = typename Model::Shape;
  GrainsView<Model> grains;
  CandidatesView candidates;
  LawsView<Model> laws;  ///< partners are species
  PairContactPlaces places;
  PairContactsView<Model> now, last;
  ContactResult* results;

  DEM_FN void operator()(std::size_t c) const {
    const std::size_t k = places.candidate[c], i = candidates.owner[k], j = candidates.partner[k];
    const int bit = places.bit[c];
    ContactHistory<Model, double> history{};
    if constexpr (history_size < Model >> 0) {
      const std::uint64_t before = last.bits[k];
      if ((before >> bit & 1u) != 0) {
        load_histories<Model>(last.histories, last.first[k] + count_bits(before & below(bit)), history);
      }
    }
    const PartnerView a = load_wide(grains.view + i), b = load_wide(grains.view + j);
    const auto point = Shape::contact_point(grains.shape_of(i), grains.pose_at(i), grains.shape_of(j),
                                            grains.pose_at(j), b.position - a.position, Shape::feature_of(bit));
    store_wide(results + c, evaluate_contact<Model>(point, a, b, laws.of(grains.species[i], grains.species[j]),
                                                    laws.time_step, history));
    store_histories<Model>(now.histories, c, history);
  }
};

}  // namespace dem::flat
