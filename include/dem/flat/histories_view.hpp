#pragma once

#include <dem/grain/contact_list.hpp>

#include <bit>
#include <cstddef>
#include <type_traits>

namespace dem::flat {

/// The histories of contacts in flat memory: number k of contact c stands at values[k * room + c].
struct HistoriesView {
  double* values;
  std::size_t room;
};

/// The numbers of one law's history, from row `row` on.
template <class History>
DEM_FN void load_history(const HistoriesView& from, int row, std::size_t c, History& h) {
  if constexpr (!std::is_empty_v<History>) {
    struct Fields {
      double value[sizeof(History) / sizeof(double)];
    } fields;
    for (std::size_t k = 0; k < sizeof(History) / sizeof(double); ++k) {
      fields.value[k] = from.values[(static_cast<std::size_t>(row) + k) * from.room + c];
    }
    h = std::bit_cast<History>(fields);
  }
}
template <class History>
DEM_FN void store_history(const HistoriesView& to, int row, std::size_t c, const History& h) {
  if constexpr (!std::is_empty_v<History>) {
    struct Fields {
      double value[sizeof(History) / sizeof(double)];
    };
    const auto fields = std::bit_cast<Fields>(h);
    for (std::size_t k = 0; k < sizeof(History) / sizeof(double); ++k) {
      to.values[(static_cast<std::size_t>(row) + k) * to.room + c] = fields.value[k];
    }
  }
}

/// At which row the history of each law begins, as in the chunks' lists.
template <class Model>
struct HistoryRows {
  static constexpr int normal = 0, friction = normal_history_size<Model>,
                       rolling = friction + friction_history_size<Model>,
                       cohesion = rolling + rolling_history_size<Model>;
};

/// What contact c remembers.
template <class Model>
DEM_FN void load_histories(const HistoriesView& from, std::size_t c, ContactHistory<Model, double>& h) {
  load_history(from, HistoryRows<Model>::normal, c, h.normal);
  load_history(from, HistoryRows<Model>::friction, c, h.friction);
  load_history(from, HistoryRows<Model>::rolling, c, h.rolling);
  load_history(from, HistoryRows<Model>::cohesion, c, h.cohesion);
}
template <class Model>
DEM_FN void store_histories(const HistoriesView& to, std::size_t c, const ContactHistory<Model, double>& h) {
  store_history(to, HistoryRows<Model>::normal, c, h.normal);
  store_history(to, HistoryRows<Model>::friction, c, h.friction);
  store_history(to, HistoryRows<Model>::rolling, c, h.rolling);
  store_history(to, HistoryRows<Model>::cohesion, c, h.cohesion);
}

}  // namespace dem::flat
