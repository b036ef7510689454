// What other programs find in a file of a state.

#include "folder.hpp"

#include <dem/io/checkpoint/hdf5_file.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace hdf5_file_test {

namespace {

/// Of a text in the file: its bytes, and how they are declared.
struct Text {
  std::string bytes;
  H5T_cset_t set = H5T_CSET_ERROR;
};
Text text_of(const std::filesystem::path& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), data = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t type = H5Dget_type(data);
  Text text{std::string(H5Tget_size(type), '\0'), H5Tget_cset(type)};
  CHECK(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.bytes.data()) >= 0);
  H5Tclose(type), H5Dclose(data), H5Fclose(file);
  return text;
}

dem::io::StateColumns a_name(std::string name) {
  dem::io::StateColumns columns;
  dem::io::Fields v(dem::io::Fields::Task::collect, columns);
  v("name", name);
  columns.at("name").unit = "µm";
  return columns;
}

}  // namespace

TEST_CASE("texts of a state are declared as what they are, UTF-8") {
  const Folder folder;
  dem::io::write_columns(folder / "state.h5", a_name("Räder"));
  const Text text = text_of(folder / "state.h5", "name");
  CHECK(text.bytes == "Räder");
  CHECK(text.set == H5T_CSET_UTF8);
  const auto columns = dem::io::read_columns(folder / "state.h5");
  CHECK(columns.at("name").texts == std::vector<std::string>{"Räder"});
  CHECK(columns.at("name").unit == "µm");
}

TEST_CASE("a state is written through a link, which stays") {
  const Folder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/state.h5", folder / "link.h5");
  for (const char* name : {"old", "new"}) dem::io::write_columns(folder / "link.h5", a_name(name));
  CHECK(std::filesystem::is_symlink(folder / "link.h5"));
  CHECK(dem::io::read_columns(folder / "there/state.h5").at("name").texts == std::vector<std::string>{"new"});
  CHECK(std::distance(std::filesystem::directory_iterator(folder / "there"), {}) == 1);
}

}  // namespace hdf5_file_test
