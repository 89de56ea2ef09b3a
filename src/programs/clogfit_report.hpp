#pragma once

namespace clog {

/// `clogfit report`: one page of HTML about a sweep. Becomes analysis/report.py, which asks this clogfit for
/// the numbers; returns only by an exception.
/// @throws Error  if the script is not where the programs were built
int clogfit_report(int argc, const char* const* argv);

}  // namespace clog
