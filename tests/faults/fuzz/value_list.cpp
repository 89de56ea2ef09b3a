/// Fuzz target that reads lists of values, as on the command line. The first byte selects the kind of the
/// values.

#include "clog/sweep/value_list.hpp"

#include <vector>

#include "fuzz.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto kind = static_cast<ValueKind>(data[0] % 3);
  const std::vector<std::string> words = {"auto", "dp"};
  may_be_refused([&] {
    const std::vector<std::string> values = sweep::expand_list(text_of(data + 1, size - 1), kind, words);
    for (const std::string& value : {values.front(), values.back()})
      // a single value must be unchanged.
      require(sweep::expand_list(value, kind, words) == std::vector{value});
  });
  return 0;
}
