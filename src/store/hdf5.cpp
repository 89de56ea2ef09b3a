#include "hdf5.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/memory.hpp"
#include "clog/store/regular_file.hpp"
#include "clog/store/run_table.hpp"
#include "draft.hpp"
#include "file_io.hpp"
#include "seal.hpp"

namespace clog::store {

void prepare_library() {
  static const bool is_prepared = [] {
    H5dont_atexit();  // before anything else: asking for the version begins it, too
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    return true;
  }();
  if (is_prepared) H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // of this thread
}

void require_memory_of_file(const std::string& purpose, std::size_t size, int copies) {
  constexpr std::size_t of_the_library = 16'000'000;
  require_memory(purpose, static_cast<std::size_t>(copies) * size + of_the_library);
}

namespace {

constexpr std::string_view hdf5_mark = "\x89HDF\r\n\x1a\n";

}  // namespace

void refuse_existing(const std::string& path) {
  if (std::filesystem::exists(path))
    throw Error("will not overwrite " + path + " (it exists); give another name, or remove it first");
}

void refuse_unwritable(const std::string& path) {
  refuse_existing(path);
  const Draft draft(path, hdf5_mark);
}

namespace {

/// The bytes of a file of the earliest format. It is filled in memory, so that the library never meets a disk
/// that is full, which it does not always survive.
std::vector<std::byte> file_image(const std::string& path, const std::function<void(hid_t file)>& fill) {
  prepare_library();
  constexpr std::size_t growth = std::size_t{1} << 20;
  const PropertyList access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  H5Pset_fapl_core(access, growth, false);
  errno = 0;
  const File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  check(file.valid(), "create", path);
  fill(file);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "write", path);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size > 0, "write", path);
  std::vector<std::byte> image(static_cast<std::size_t>(size));
  check(H5Fget_file_image(file, image.data(), image.size()) == size, "write", path);
  return image;
}

void write_draft(Draft& draft, const std::string& path, const std::function<void(hid_t file)>& fill) {
  const std::vector<std::byte> image = file_image(path, fill);
  const std::string seal = seal_of(image);
  draft.write(image);
  draft.write(std::as_bytes(std::span(seal)));
  draft.unlock();
}

}  // namespace

void create_whole(const std::string& path, const std::function<void(hid_t file)>& fill) {
  refuse_existing(path);
  Draft draft(path, hdf5_mark);
  write_draft(draft, path, fill);
  draft.publish_new();
}

bool replace_whole(const OutputPath& place, const std::function<void(hid_t file)>& fill) {
  Draft draft(place, hdf5_mark);
  write_draft(draft, place.path(), fill);
  return draft.publish();
}

std::optional<std::string> replace_whole(const OutputPath& place, const std::string& stamp,
                                         const std::function<void(hid_t file)>& fill) {
  Draft draft(place, hdf5_mark);
  write_draft(draft, place.path(), fill);
  return draft.publish_over(stamp);
}

std::vector<std::byte> read_file(const std::string& path) {
  const int descriptor = open(require_regular(path).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT)
    throw Error("cannot read " + path + " (no such file); check the name");
  if (descriptor < 0) throw Error("cannot read " + path + " (" + std::strerror(errno) + ")");
  try {
    struct stat status {};
    check(fstat(descriptor, &status) == 0, "read", path);
    // The image, two of the library, packed rows, and rows: 25 MB want 165 MB in all.
    constexpr int copies = 6;
    require_memory_of_file("read " + path, static_cast<std::size_t>(status.st_size), copies);
    std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
    read_at(descriptor, bytes, 0, path);
    close(descriptor);
    return bytes;
  } catch (...) {
    close(descriptor);
    throw;
  }
}

File open_image(std::vector<std::byte>& image, const std::string& path) {
  prepare_library();
  const std::string_view content(reinterpret_cast<const char*>(image.data()), image.size());
  if (!content.starts_with(hdf5_mark))
    throw Error("cannot read " + path + " (not an HDF5 file); give a file written by clogsweep");
  const PropertyList access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, image.size(), false);
  H5Pset_file_image(access, image.data(), image.size());
  constexpr const char* no_file = "/dev/null/image";  // the library wants a name that nothing has
  File file(H5Fopen(no_file, H5F_ACC_RDONLY, access));
  if (!file.valid())
    throw Error("cannot read " + path +
                " (damaged: it is cut off, or its beginning is not as it was written); restore it from a "
                "copy, or start "
                "a new file");
  return file;
}

Type text_type(std::size_t length) {
  Type type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, length > 0 ? length : 1);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

std::vector<std::string> names_in(hid_t group) {
  std::vector<std::string> names;
  H5Literate(
      group, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* all) {
        static_cast<std::vector<std::string>*>(all)->emplace_back(name);
        return herr_t{0};
      },
      &names);
  return names;
}

std::string member_name(hid_t type, unsigned index) {
  char* name = H5Tget_member_name(type, index);
  if (!name) return {};
  std::string text = name;
  H5free_memory(name);
  return text;
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Type type = text_type(text.size());
  const Space space(H5Screate(H5S_SCALAR));
  const Attribute attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  if (!attribute.valid() || H5Awrite(attribute, type, text.empty() ? "\0" : text.c_str()) < 0)
    throw Error("cannot write the attribute " + name);
}

std::string read_attribute(hid_t object, const std::string& name) {
  constexpr std::size_t longest = 65536;  // an object's header holds no more
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Attribute attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  if (!attribute.valid()) return {};
  const Type type(H5Aget_type(attribute));
  const Space space(H5Aget_space(attribute));
  const bool is_text = type.valid() && H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
                       H5Tget_size(type) <= longest && space.valid() &&
                       H5Sget_simple_extent_npoints(space) == 1;
  if (!is_text) return {};
  std::vector<char> text(H5Tget_size(type));
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return {text.data(), strnlen(text.data(), text.size())};
}

namespace {

/// Nothing if they cannot be counted. H5Oget_info has other structures since HDF5 1.12, whose names 1.10 does
/// not have.
std::optional<hsize_t> count_attributes(hid_t object) {
#if H5_VERSION_GE(1, 12, 0)
  H5O_info2_t info;
  if (H5Oget_info3(object, &info, H5O_INFO_NUM_ATTRS) < 0) return {};
#else
  H5O_info_t info;
  if (H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS) < 0) return {};
#endif
  return info.num_attrs;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> read_attributes(hid_t file, const std::string& path) {
  std::vector<std::pair<std::string, std::string>> all;
  const std::optional<hsize_t> num_attributes = count_attributes(file);
  check(num_attributes.has_value(), "read the attributes of", path);
  for (hsize_t i = 0; i < *num_attributes; ++i) {
    const Attribute attribute(
        H5Aopen_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT));
    char name[256];
    if (attribute.valid() && H5Aget_name(attribute, sizeof name, name) >= 0)
      all.emplace_back(name, read_attribute(file, name));
  }
  return all;
}

}  // namespace clog::store
