#pragma once

#include <dem/core/error.hpp>

#include <memory>

namespace dem::exec {

/// What an executor with memory of its own keeps there for a world. A copy of the executor keeps nothing: its world
/// brings its own.
class Kept {
 public:
  Kept() = default;
  /// Throws Error within a run: a copy would have the grains of before it.
  Kept(const Kept& other) { other.require_home("copied"); }
  Kept& operator=(const Kept& other) {
    other.require_home("copied");
    require_home("written over");
    kept_ = nullptr;
    return *this;
  }
  Kept(Kept&&) = default;
  Kept& operator=(Kept&&) = default;

  /// The one T of this executor, made by the first call. Every call names the same T.
  template <class T>
  T& kept() {
    if (!kept_) kept_ = std::shared_ptr<void>(new T(), [](void* p) { delete static_cast<T*>(p); });
    return *static_cast<T*>(kept_.get());
  }
  /// Whether the grains are in the executor's memory now, and those of the world are old.
  bool holds_grains() const { return holds_grains_; }
  void set_holds_grains(bool holds) { holds_grains_ = holds; }

 private:
  void require_home(const char* what) const {
    if (holds_grains_) fail("a world is {} within its run, while its grains are in the executor's memory", what);
  }

  std::shared_ptr<void> kept_;
  bool holds_grains_ = false;
};

}  // namespace dem::exec
