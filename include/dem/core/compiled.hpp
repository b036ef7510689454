#pragma once

/// What no model changes stands at the end of its header, within `#if DEM_DEFINES` and after what it alone includes,
/// and begins with DEM_INLINE. A program may have it compiled once (CMake's target dem::compiled): then
/// dem/compiled.cpp, one of its sources, holds these definitions, and all others are compiled with DEM_COMPILED defined
/// and see declarations alone. Else each source has them, as in any header-only library.
///
/// DEM_LAZY before such a declaration and DEM_LAZY_INLINE before its definition make the function a template without a
/// choice where each source has it: those that do not call it skip what stands in it. For long work at set-up that few
/// programs need, such as the repair of meshes.
#if defined(DEM_COMPILING)
#define DEM_DEFINES 1
#define DEM_INLINE __attribute__((used)) inline
#define DEM_LAZY
#define DEM_LAZY_INLINE DEM_INLINE
#elif defined(DEM_COMPILED)
#define DEM_DEFINES 0
#define DEM_LAZY
#else
#define DEM_DEFINES 1
#define DEM_INLINE inline
#define DEM_LAZY template <class DemLazy = void>
#define DEM_LAZY_INLINE    \
  template <class DemLazy> \
  inline
#endif

/// The special member functions of a class with many members: DEM_VALUE declares them within the class,
/// DEM_DEFINE_VALUE defines them behind it, as its members' are. Left to the compiler, each source has them, and those
/// of all its members' containers. The class is no aggregate then: each of its numbers needs an initialiser. Moves of
/// its members must not throw.
///
///     struct Parts {
///       DEM_VALUE(Parts)
#define DEM_VALUE(Class)              \
  Class();                            \
  Class(const Class&);                \
  Class(Class&&) noexcept;            \
  Class& operator=(const Class&);     \
  Class& operator=(Class&&) noexcept; \
  ~Class();
#define DEM_DEFINE_VALUE(Class)                                   \
  DEM_INLINE Class::Class() = default;                            \
  DEM_INLINE Class::Class(const Class&) = default;                \
  DEM_INLINE Class::Class(Class&&) noexcept = default;            \
  DEM_INLINE Class& Class::operator=(const Class&) = default;     \
  DEM_INLINE Class& Class::operator=(Class&&) noexcept = default; \
  DEM_INLINE Class::~Class() = default;

// Sources that are compiled for other vectors align them otherwise, and would misread each other's. The linker finds no
// such name then: each source asks for it.
#if defined(DEM_COMPILED)
#if defined(DEM_NO_SIMD) || defined(__CUDACC__)
#define DEM_COMPILED_FOR dem_compiled_cpp_is_compiled_without_simd_as_well
#elif defined(__AVX512F__)
#define DEM_COMPILED_FOR dem_compiled_cpp_is_compiled_for_avx512_as_well
#elif defined(__AVX__)
#define DEM_COMPILED_FOR dem_compiled_cpp_is_compiled_for_avx_as_well
#else
#define DEM_COMPILED_FOR dem_compiled_cpp_is_compiled_without_avx_as_well
#endif
extern "C" {
extern const char DEM_COMPILED_FOR;
#if defined(DEM_COMPILING)
const char DEM_COMPILED_FOR = 0;
#endif
}
namespace dem::detail {
#if __has_attribute(retain)
__attribute__((retain))
#endif
__attribute__((used)) static const char* const compiled_for = &DEM_COMPILED_FOR;
}  // namespace dem::detail
#endif
