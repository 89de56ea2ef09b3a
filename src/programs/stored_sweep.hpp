#pragma once

#include <cstdint>
#include <string>

#include "clog/store/run_table.hpp"
#include "clog/sweep/plan.hpp"

namespace clog {

/// What a sweep's file says of its sweep, apart from the rows.

/// Text of an attribute; empty if there is none.
std::string attribute(const store::Provenance& provenance, const std::string& name);
/// @throws Error that names the file, as the next two do, if it does not say, or nothing that can be read
sweep::Settings stored_settings(const std::string& path, const store::Provenance& provenance);
sweep::Plan stored_plan(const std::string& path, const store::Provenance& provenance);
/// How many runs are wanted so far: of --until-precision those asked for, otherwise all of the plan.
std::int64_t stored_num_wanted(const std::string& path, const store::Provenance& provenance,
                               const sweep::Plan& plan);

}  // namespace clog
