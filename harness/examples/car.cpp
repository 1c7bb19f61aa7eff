// A full car with inputs from a file, one row a step, one column an input: car SCENE FILE [VARIANT]
#include <cstdio>
#include <fstream>
#include <mbs/stepper.hpp>
#include <sstream>

int main(int argc, char** argv) try {
  if (argc < 3) throw mbs::Refused("car SCENE INPUTS.csv [IMPLEMENTATION]");
  mbs::Stepper car(mbs::SceneDocument::load(argv[1]), {argc > 3 ? argv[3] : "auto"});
  std::ifstream file(argv[2]);
  std::string line, name;
  std::getline(file, line);
  std::vector<int> inputs;
  for (std::istringstream in(line); std::getline(in, name, ',');) inputs.push_back(car.input(name));
  std::vector<double> z;
  for (double value; file >> value; file.ignore()) z.push_back(value);
  const std::size_t row = inputs.size();
  if (row == 0 || z.size() % row != 0 || !file.eof()) throw mbs::Refused("this is no table");
  const double dt = car.settings().step;
  const int body = car.output("body.z");
  for (std::size_t k = row; k + row < z.size(); k += row) {
    for (std::size_t i = k; i < k + row; ++i) {  // rate and acceleration by the neighbours
      const double before = z[i - row], after = z[i + row];
      car.set_input(inputs[i - k], z[i], (after - before) / (2 * dt),
                    (after - 2 * z[i] + before) / (dt * dt));
    }
    const auto [status, passes, factorizations] = car.step();
    if (status == mbs::StepStatus::factorization_failed) throw mbs::Refused("a step failed");
    std::printf("%.5f,%.9f\n", car.state().t, car.outputs()[body]);
  }
} catch (const std::exception& error) {
  return std::fprintf(stderr, "car: %s\n", error.what()), 1;
}
