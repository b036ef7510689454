#pragma once

// How long the kernels of a GPU take. Seen by nvcc alone.

#if defined(__CUDACC__)

#include <dem/parallel/cuda_memory.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::cuda {

/// The time on the GPU of what is launched, by its name. Off until it is switched on, as each kernel then stands
/// between two marks. A copy is off and empty.
class Profile {
 public:
  struct Entry {
    std::string name;
    double seconds = 0.0;
    std::size_t calls = 0;
  };

  Profile() = default;
  Profile(const Profile&) {}
  Profile& operator=(const Profile&) { return *this; }
  Profile(Profile&& other) noexcept { swap(other); }
  Profile& operator=(Profile&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Profile() {
    for (const Span& s : spans_) cudaEventDestroy(s.begin), cudaEventDestroy(s.end);
  }

  /// Switches it on, empty, or off.
  void switch_on(bool on) {
    on_ = on;
    entries_.clear();
  }
  const std::vector<Entry>& entries() const { return entries_; }

  /// Marks the end of what is timed when it goes.
  struct Timed {
    cudaEvent_t end = nullptr;
    ~Timed() {
      if (end != nullptr) cudaEventRecord(end);
    }
  };
  [[nodiscard]] Timed time(const char* name) {
    if (!on_) return {};
    if (used_ == spans_.size()) {
      Span s;
      check(cudaEventCreate(&s.begin), "an event is made");
      check(cudaEventCreate(&s.end), "an event is made");
      spans_.push_back(s);
    }
    Span& s = spans_[used_++];
    s.name = name;
    check(cudaEventRecord(s.begin), "an event is set");
    return {s.end};
  }
  /// When all that was launched is done.
  void collect() {
    for (std::size_t k = 0; k < used_; ++k) {
      float milliseconds = 0.0f;
      check(cudaEventElapsedTime(&milliseconds, spans_[k].begin, spans_[k].end), "events are read");
      Entry& e = entry(spans_[k].name);
      e.seconds += 1e-3 * static_cast<double>(milliseconds);
      ++e.calls;
    }
    used_ = 0;
  }

 private:
  struct Span {
    const char* name = "";
    cudaEvent_t begin = nullptr, end = nullptr;
  };
  void swap(Profile& other) noexcept {
    std::swap(on_, other.on_);
    std::swap(spans_, other.spans_);
    std::swap(used_, other.used_);
    std::swap(entries_, other.entries_);
  }
  Entry& entry(std::string_view name) {
    for (Entry& e : entries_) {
      if (e.name == name) return e;
    }
    return entries_.emplace_back(Entry{std::string(name)});
  }

  bool on_ = false;
  std::vector<Span> spans_;
  std::size_t used_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace dem::cuda

#endif
