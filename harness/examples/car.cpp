// A full car over a road from a file: ./car car.json road.csv [IMPLEMENTATION]; one row a step, one column an input.
#include <cstdio>
#include <fstream>
#include <mbs/stepper.hpp>
#include <sstream>

int main(int argc, char** argv) try {
  if (argc < 3) throw mbs::Refused("car SCENE INPUTS.csv [IMPLEMENTATION]");
  std::ifstream file(argv[2]);
  std::string line, cell;
  if (!std::getline(file, line)) throw mbs::Refused(std::string(argv[2]) + " cannot be read");
  mbs::Stepper car(mbs::SceneDocument::load(argv[1]), {.implementation = argc > 3 ? argv[3] : "auto"});
  std::vector<int> inputs;
  for (std::istringstream names(line); std::getline(names, cell, ',');) inputs.push_back(car.input(cell));
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    rows.emplace_back();
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
    if (rows.back().size() != inputs.size()) throw mbs::Refused("a row has another number of columns than the first");
  }
  const double dt = car.settings().step;
  const int body = car.output("body.z");
  for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {  // rate and acceleration by the neighbours
      const double before = rows[k - 1][i], now = rows[k][i], after = rows[k + 1][i];
      car.set_input(inputs[i], now, (after - before) / (2 * dt), (after - 2 * now + before) / (dt * dt));
    }
    if (car.step().status == mbs::StepStatus::factorization_failed) throw std::runtime_error("a step failed");
    std::printf("%.5f,%.9f\n", car.state().t, car.outputs()[body]);
  }
} catch (const std::exception& error) {
  return std::fprintf(stderr, "car: %s\n", error.what()), 1;
}
