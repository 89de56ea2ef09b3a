#include "hdf5.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

#include "clog/core/error.hpp"
#include "clog/store/run_table.hpp"
#include "draft.hpp"

namespace clog::store {

void prepare_library() {
  // The library's own clean-up at exit crashes after a write that failed; what we open, we close.
  H5dont_atexit();
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

namespace {

constexpr std::string_view hdf5_mark = "\x89HDF\r\n\x1a\n";

}  // namespace

void refuse_existing(const std::string& path) {
  if (std::filesystem::exists(path))
    throw Error("will not overwrite " + path + " (it exists); give another --output, or remove it first");
}

void refuse_unwritable(const std::string& path) {
  refuse_existing(path);
  const Draft draft(path, hdf5_mark);
}

namespace {

/// Makes a file in the earliest format in place of the draft, and has it filled.
void write_draft(const Draft& draft, const std::string& path, const std::function<void(hid_t file)>& fill) {
  prepare_library();
  const PropertyList access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  errno = 0;
  const File file(H5Fcreate(draft.name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  check(file.valid(), "create", path);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "write", path);  // the mark comes first
  fill(file);
  errno = 0;
  check(H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0, "write", path);
}

}  // namespace

void create_whole(const std::string& path, const std::function<void(hid_t file)>& fill) {
  refuse_existing(path);
  Draft draft(path, hdf5_mark);
  write_draft(draft, path, fill);
  draft.unlock();
  draft.publish_new();
}

void replace_whole(const std::string& path, const std::function<void(hid_t file)>& fill) {
  Draft draft(path, hdf5_mark);
  write_draft(draft, path, fill);
  draft.unlock();
  draft.publish();
}

File open_file(const std::string& path, unsigned flags) {
  prepare_library();
  if (!std::filesystem::exists(path)) throw Error("cannot read " + path + " (no such file); check the name");
  if (access(path.c_str(), R_OK) != 0) throw Error("cannot read " + path + " (" + std::strerror(errno) + ")");
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw Error("cannot read " + path + " (not an HDF5 file); give a file written by clogsweep");
  errno = 0;
  File file(H5Fopen(path.c_str(), flags, H5P_DEFAULT));
  check(file.valid(), "open", path);
  return file;
}

Type text_type(std::size_t length) {
  Type type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type, length > 0 ? length : 1);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Type type = text_type(text.size());
  const Space space(H5Screate(H5S_SCALAR));
  const Attribute attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  if (!attribute.valid() || H5Awrite(attribute, type, text.empty() ? "\0" : text.c_str()) < 0)
    throw Error("cannot write the attribute " + name);
}

std::string read_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Attribute attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  const Type type(H5Aget_type(attribute));
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return {};
  std::vector<char> text(H5Tget_size(type));
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return {text.data(), strnlen(text.data(), text.size())};
}

}  // namespace clog::store
