/// Fuzz target that reads a config and plans the sweep. The config has the form that is stored with a sweep
/// and sent to its ranks.

#include "clog/sweep/plan.hpp"
#include "clog/sweep/settings.hpp"
#include "fuzz.hpp"

using namespace clog;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  may_be_refused([&] {
    const auto settings = sweep::Settings::from_config(text_of(data, size));
    const std::string config = settings.to_config(sweep::Comments::help);
    require(sweep::Settings::from_config(config).to_config(sweep::Comments::help) == config);
    const sweep::Plan plan(settings);
    require(plan.size() > 0);
    plan.task(plan.size() - 1);
  });
  return 0;
}
