#pragma once

#include <dem/flat/histories_view.hpp>
#include <dem/grain/contact_list.hpp>

#include <cstddef>
#include <vector>

namespace dem::flat {

/// The histories of a step's contacts in the executor's memory: a column for each number of a history.
template <class Model>
class HistoryStore {
 public:
  static constexpr auto size = static_cast<std::size_t>(history_size<Model>);
  using Columns = std::vector<std::vector<double>>;  ///< by number and contact

  /// Room for so many contacts, and a fourth more where there was too little. Old histories are lost then.
  void make_room(std::size_t contacts) {
    if (contacts > room_) room_ = (contacts + contacts / 4 + 31) / 32 * 32;
    values_.make_room(size * room_);
    contacts_ = contacts;
  }
  void upload(const Columns& columns) {
    for (std::size_t h = 0; h < size; ++h) values_.upload_to(h * room_, columns[h].data(), contacts_);
  }
  Columns download() {
    Columns columns(size, std::vector<double>(contacts_));
    for (std::size_t h = 0; h < size; ++h) values_.download(columns[h].data(), contacts_, h * room_);
    return columns;
  }

  std::size_t contacts() const { return contacts_; }
  std::size_t room() const { return room_; }
  std::size_t bytes() const { return values_.bytes(); }
  auto view() { return HistoriesView{values_.data(), room_}; }

 private:
  typename Model::Executor::template Array<double> values_;
  std::size_t room_ = 0, contacts_ = 0;
};

}  // namespace dem::flat
