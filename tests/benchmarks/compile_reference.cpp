// This file never changes. tests/benchmarks/build.sh divides compile times by the time for this file, so that
// different machines can be compared. The file uses the libraries with the headers that take longest to
// compile.

#include <Eigen/Dense>
#include <boost/program_options.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

Eigen::VectorXd solved(int size) {
  Eigen::MatrixXd matrix(size, size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) matrix(i, j) = i == j ? size : std::cos(i + 2.0 * j);
  return matrix.partialPivLu().solve(Eigen::VectorXd::Ones(size));
}

std::string written(const Eigen::VectorXd& numbers) {
  nlohmann::ordered_json document;
  document["numbers"] = std::vector<double>(numbers.begin(), numbers.end());
  document["names"] = std::map<std::string, double>{{"sum", numbers.sum()}, {"norm", numbers.norm()}};
  return document.dump(2);
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options;
  options.add_options()("size", po::value<int>()->default_value(4));
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, options), values);
  return written(solved(values["size"].as<int>())).empty() ? 1 : 0;
}
