// Who shears grains of their own includes a world, and nothing that is for programs.

#include <dem/rig/direct_shear.hpp>

#if defined(CLI11_VERSION) || defined(_GLIBCXX_FILESYSTEM) || defined(_GLIBCXX_REGEX) || defined(_GLIBCXX_IOSTREAM)
#error "<dem/rig/direct_shear.hpp> includes CLI11, <filesystem>, <regex> or <iostream>"
#endif
