#pragma once

#include <hdf5.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clog/store/output_path.hpp"

/// Thin ownership of HDF5 identifiers; only src/store includes this.
namespace clog::store {

/// Owns one HDF5 identifier and closes it with the function of its kind.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  explicit Handle(hid_t id = -1) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) Close(id_);
  }
  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
};

using File = Handle<H5Fclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using PropertyList = Handle<H5Pclose>;
using Group = Handle<H5Gclose>;

/// Must come before the first use of the library: no clean-up of its own at exit, which crashes after a write
/// that failed; no error stack on the screen (we print one line of our own); and no file locks (a reader that
/// has the file open must not make a row fail to be written; they also fail on many cluster file systems).
void prepare_library();

/// The library's image, which grows by copying, and ours.
constexpr int copies_in_writing = 3;

/// The library makes copies of what it reads and writes, and may crash where there is no memory for them.
/// @param purpose  as in "read sweep.h5"; @param size  of the file [bytes]
/// @throws Error if there is not so much
void require_memory_of_file(const std::string& purpose, std::size_t size, int copies = copies_in_writing);

/// Has a file of the earliest format filled in memory, writes it as a draft with a seal at its end and
/// publishes it: the path never holds half a file. @throws Error if the path exists or cannot be written
void create_whole(const std::string& path, const std::function<void(hid_t file)>& fill);
/// The same, replacing a file that is there: Draft::publish(). One process at a time.
bool replace_whole(const OutputPath& place, const std::function<void(hid_t file)>& fill);
/// The same, but only in place of the file with this OutputPath::stamp(), or of none: Draft::publish_over().
std::optional<std::string> replace_whole(const OutputPath& place, const std::string& stamp,
                                         const std::function<void(hid_t file)>& fill);

/// All that a regular file holds. @throws Error that says what is wrong with the path
std::vector<std::byte> read_file(const std::string& path);
/// Opens the bytes of a file for reading, so that what was checked is what is read. They are copied.
/// @throws Error naming the path if they are no HDF5 file
File open_image(std::vector<std::byte>& image, const std::string& path);

/// Fixed-length, zero-padded text; the length is at least 1.
Type text_type(std::size_t length);
/// Names of what is in a group.
std::vector<std::string> names_in(hid_t group);
/// Name of a member of a compound type; empty if there is none.
std::string member_name(hid_t type, unsigned index);
void write_attribute(hid_t object, const std::string& name, const std::string& text);
/// Empty if there is none, or one that is no text of fixed length.
std::string read_attribute(hid_t object, const std::string& name);
/// Name and text of every attribute of an open file's root. @throws Error naming the path
std::vector<std::pair<std::string, std::string>> read_attributes(hid_t file, const std::string& path);

}  // namespace clog::store
