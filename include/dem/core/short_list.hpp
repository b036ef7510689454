#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace dem {

/// An allocator whose first N items have room on the stack. Beyond them it takes the heap.
template <class T, std::size_t N>
class ShortRoom {
 public:
  using value_type = T;
  template <class U>
  struct rebind {
    using other = ShortRoom<U, N>;
  };

  explicit ShortRoom(std::byte* room) : room_(room) {}
  T* allocate(std::size_t n) { return has_room(n) ? reinterpret_cast<T*>(room_) : std::allocator<T>().allocate(n); }
  void deallocate(T* at, std::size_t n) {
    if (!has_room(n)) std::allocator<T>().deallocate(at, n);
  }
  /// A copy of the list has no room of its own.
  [[nodiscard]] ShortRoom select_on_container_copy_construction() const { return ShortRoom(nullptr); }
  bool operator==(const ShortRoom& other) const { return room_ == other.room_; }

 private:
  [[nodiscard]] bool has_room(std::size_t n) const { return n <= N && room_ != nullptr; }

  std::byte* room_;
};

/// What one query gathers: up to N items cost no memory of the heap.
template <class T, std::size_t N>
class ShortList {
  alignas(T) std::byte room_[N * sizeof(T)];

 public:
  using Items = std::vector<T, ShortRoom<T, N>>;
  Items items{ShortRoom<T, N>(room_)};

  ShortList() { items.reserve(N); }  // once and for all, as the room is one
  ShortList(const ShortList&) = delete;
  ShortList& operator=(const ShortList&) = delete;
};

}  // namespace dem
