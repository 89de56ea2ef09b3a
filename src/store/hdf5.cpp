#include "hdf5.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "clog/core/tools/error.hpp"
#include "clog/core/tools/memory.hpp"
#include "clog/store/run_table.hpp"
#include "draft.hpp"
#include "file_io.hpp"
#include "seal.hpp"

namespace clog::store {

void prepare_library() {
  // This comes first, because even a query of the version initialises the library.
  static const herr_t is_prepared = H5dont_atexit();
  if (is_prepared >= 0) H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the error stack of this thread
}

void require_memory_of_file(const std::string& purpose, std::size_t size, int copies) {
  constexpr std::size_t of_the_library = 16'000'000;
  require_memory(purpose, static_cast<std::size_t>(copies) * size + of_the_library);
}

namespace {

constexpr std::string_view hdf5_mark = "\x89HDF\r\n\x1a\n";

/// Builds a file of the earliest format in memory and passes its bytes to use(). The library does not write
/// the file itself, because it may crash if the disk is full.
void with_file_image(const std::string& path, const std::function<void(hid_t file)>& fill,
                     const std::function<void(std::span<const std::byte> image)>& use) try {
  prepare_library();
  constexpr std::size_t growth = std::size_t{1} << 20;
  const PropertyList access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  H5Pset_fapl_core(access, growth, false);
  const File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  if (!file.valid()) throw LibraryError("create a file");
  fill(file);
  const ssize_t size =
      H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0 ? H5Fget_file_image(file, nullptr, 0) : ssize_t{0};
  void* image = nullptr;  // address of the image in the library's driver; using this image avoids a copy
  if (size <= 0 || H5Fget_vfd_handle(file, access, &image) < 0) throw LibraryError("pass on the file");
  use({*static_cast<const std::byte* const*>(image), static_cast<std::size_t>(size)});
} catch (const LibraryError& error) {
  throw Error("cannot write " + path + " (HDF5 cannot " + error.what() +
              " in memory); allow more memory (ulimit -v)");
}

}  // namespace

void refuse_to_overwrite(const std::string& path) {
  throw Error("will not overwrite " + path + " (it exists); give another name, or remove it first");
}

void refuse_existing(const std::string& path) {
  if (std::filesystem::exists(path)) refuse_to_overwrite(path);
}

void refuse_unwritable(const std::string& path) {
  refuse_existing(path);
  const Draft draft(OutputPath::resolve(path), hdf5_mark);
}

std::optional<std::string> write_whole(const OutputPath& place, const std::string& stamp,
                                       const std::function<void(hid_t file)>& fill) {
  Draft draft(place, hdf5_mark);
  with_file_image(place.path(), fill, [&](std::span<const std::byte> image) {
    const std::string seal = seal_of(image);
    draft.write(image);
    draft.write(std::as_bytes(std::span(seal)));
  });
  draft.unlock();
  return draft.publish(stamp);
}

std::vector<std::byte> read_file(const std::string& path) {
  const Descriptor file(open(require_regular(path).c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open() && errno == ENOENT)
    throw Error("cannot read " + path + " (no such file); check the name");
  if (!file.is_open()) throw FileError(FileAction::read, path, last_error());
  constexpr int copies = 2;  // the image, and the rows in it
  require_memory_of_file("read " + path, size_of(file, path), copies);
  return read_all(file, path);
}

File open_image(std::vector<std::byte>& image, const std::string& path) {
  prepare_library();
  const std::string_view content(reinterpret_cast<const char*>(image.data()), image.size());
  if (!content.starts_with(hdf5_mark))
    throw Error("cannot read " + path + " (not an HDF5 file); give a file written by clogsweep");
  const PropertyList access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, image.size(), false);
  // Without these callbacks the library would make two copies.
  H5FD_file_image_callbacks_t no_copies = {
      [](std::size_t, H5FD_file_image_op_t, void* bytes) { return bytes; },
      [](void* bytes, const void*, std::size_t, H5FD_file_image_op_t, void*) { return bytes; },
      nullptr,
      [](void*, H5FD_file_image_op_t, void*) { return herr_t{0}; },
      [](void* bytes) { return bytes; },
      [](void*) { return herr_t{0}; },
      image.data()};
  H5Pset_file_image_callbacks(access, &no_copies);
  H5Pset_file_image(access, image.data(), image.size());
  constexpr const char* no_file = "/dev/null/image";  // the library needs an unused name
  File file(H5Fopen(no_file, H5F_ACC_RDONLY, access));
  if (!file.valid())
    throw Error("cannot read " + path +
                " (damaged: it is cut off, or its beginning is not as it was written); restore it from a "
                "copy, or start "
                "a new file");
  return file;
}

Space space_of(std::initializer_list<hsize_t> shape) {
  return Space(H5Screate_simple(static_cast<int>(shape.size()), std::data(shape), nullptr));
}

PropertyList without_library_check() {
  PropertyList properties(H5Pcreate(H5P_DATASET_XFER));
  H5Pset_edc_check(properties, H5Z_DISABLE_EDC);
  return properties;
}

PropertyList checked_chunks(hsize_t num_rows) {
  PropertyList properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(properties, 1, &num_rows);
  H5Pset_fletcher32(properties);
  return properties;
}

Dataset write_dataset(hid_t parent, const std::string& name, hid_t type, hid_t space, const void* data,
                      hid_t properties) {
  Dataset dataset(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  if (!dataset.valid() || (data && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
    throw LibraryError("write " + name);
  return dataset;
}

std::optional<hsize_t> length_of(hid_t dataset) {
  const Space space(H5Dget_space(dataset));
  hsize_t length = 0;
  if (H5Sget_simple_extent_ndims(space) != 1 || H5Sget_simple_extent_dims(space, &length, nullptr) != 1)
    return std::nullopt;
  return length;
}

bool can_hold(hid_t dataset, hsize_t number, std::size_t bytes_each) {
  constexpr hsize_t most_compressed = 1100;  // the zlib of h5repack does not exceed 1032
  return number / most_compressed <= H5Dget_storage_size(dataset) / bytes_each;
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

std::vector<std::string> attributes_of(hid_t object) {
  std::vector<std::string> names;
  H5Aiterate2(
      object, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* all) {
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
    throw LibraryError("write the attribute " + name);
}

std::string read_attribute(hid_t object, const std::string& name) {
  constexpr std::size_t longest = 65536;  // the limit of an object's header
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

}  // namespace clog::store
