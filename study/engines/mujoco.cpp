// MuJoCo: nested bodies with hinges in joint coordinates; loops closed by "connect" equality
// constraints.
#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstring>
#include <iterator>

#include "engine.hpp"

namespace engines {
namespace {

std::string text(const char* format, auto... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// The body of rod `i` with those that are pinned to its end, as MJCF.
std::string body(const Mechanism& mechanism, int i) {
  const Rod& rod = mechanism.rods[static_cast<std::size_t>(i)];
  const bool ground = rod.parent < 0;
  const Rod* up = ground ? nullptr : &mechanism.rods[static_cast<std::size_t>(rod.parent)];
  std::string xml = text("<body name='r%d' pos='%.17g 0 0' euler='0 0 %.17g'>", i,
                         ground ? rod.anchor : up->length, rod.angle - (ground ? 0.0 : up->angle));
  xml += text("<joint name='r%d' type='hinge' axis='0 0 1'/>", i);
  xml += text("<inertial pos='%.17g 0 0' mass='%.17g' diaginertia='%.17g %.17g %.17g'/>",
              rod.length / 2, rod.mass, rod.inertia(), rod.inertia(), rod.inertia());
  for (int child = i + 1; child < std::ssize(mechanism.rods); ++child) {
    if (mechanism.rods[static_cast<std::size_t>(child)].parent == i) xml += body(mechanism, child);
  }
  return xml + "</body>\n";
}

/// solref: time constant (s) and damping ratio; solimp: impedance, the same at any violation.
std::string closures(const Mechanism& mechanism, Settings& settings, double step) {
  const double steps = settings.number("timeconst-steps", 0.0);
  const double constant = steps > 0.0 ? steps * step : 0.02;  // MuJoCo's own value
  const double impedance = settings.number("impedance", 0.0);
  const std::string solimp =
      impedance > 0.0 ? text("solimp='%.17g %.17g 0.001'", impedance, impedance) : "";
  std::string xml;
  for (const Loop& loop : mechanism.loops) {
    xml += text("<connect body1='r%d' body2='r%d' anchor='%.17g 0 0' solref='%.17g 1' %s/>\n",
                loop.rod, loop.other, mechanism.rods[static_cast<std::size_t>(loop.rod)].length,
                constant, solimp.c_str());
  }
  return xml;
}

/// Collisions are off, as nothing collides.
std::string model_xml(const Mechanism& mechanism, Settings& settings) {
  const std::vector<std::string> integrators{"Euler", "RK4", "implicit"},
      solvers{"Newton", "CG", "PGS"};
  const double step = settings.positive("step", 2e-3);  // MuJoCo's own values here and below
  std::string xml = "<mujoco><compiler angle='radian' inertiafromgeom='false'/>\n";
  xml += text(
      "<option timestep='%.17g' gravity='0 %.17g 0' integrator='%s' solver='%s' "
      "tolerance='%g'><flag contact='disable' refsafe='%s'/></option>\n",
      step, -kGravity, integrators[settings.choice("integrator", integrators)].c_str(),
      solvers[settings.choice("solver", solvers)].c_str(),
      settings.number("solver-tolerance", 1e-8),
      settings.choice("refsafe", {"on", "off"}) == 0 ? "enable" : "disable");
  xml += "<worldbody>\n";
  for (int i = 0; i < std::ssize(mechanism.rods); ++i) {
    if (mechanism.rods[static_cast<std::size_t>(i)].parent < 0) xml += body(mechanism, i);
  }
  xml += "</worldbody>\n<equality>\n";
  return xml + closures(mechanism, settings, step) + "</equality></mujoco>\n";
}

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

mjModel* compile(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[500] = "";
  mjModel* model = mj_loadXML("model.xml", files.get(), error, sizeof error);
  mj_deleteFileVFS(files.get(), "model.xml");
  if (model == nullptr) throw UsageError(std::string("MuJoCo refuses the model: ") + error);
  return model;
}

class MujocoEngine final : public FixedStepEngine {
 public:
  MujocoEngine(const Mechanism& mechanism, Settings& settings)
      : FixedStepEngine(settings),
        mechanism_(mechanism),
        model_(compile(model_xml(mechanism, settings))),
        data_(mj_makeData(model_.get())),
        angles_(mechanism.rods.size()),
        rates_(mechanism.rods.size()) {
    for (std::size_t i = 0; i < mechanism.rods.size(); ++i) {
      const int joint =
          mj_name2id(model_.get(), mjOBJ_JOINT, text("r%d", static_cast<int>(i)).c_str());
      places_.push_back(static_cast<std::size_t>(joint));  // hinges only: a coordinate a joint
      const Rod& rod = mechanism.rods[i];
      const Rod* up =
          rod.parent < 0 ? nullptr : &mechanism.rods[static_cast<std::size_t>(rod.parent)];
      data_->qvel[joint] = rod.rate - (up != nullptr ? up->rate : 0.0);
      offsets_.push_back(rod.angle - (up != nullptr ? up->angle : 0.0));
    }
  }

  void read(std::vector<RodState>& states) const override {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      angles_[i] = offsets_[i] + data_->qpos[places_[i]];
      rates_[i] = data_->qvel[places_[i]];
    }
    states_of_joints(mechanism_, angles_, rates_, states);
  }

 protected:
  void do_step() override {
    mj_step(model_.get(), data_.get());
    // MuJoCo warns, puts the model back to its start and goes on.
    for (const int bad : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      if (data_->warning[bad].number > 0)
        throw std::runtime_error("MuJoCo found huge or not finite values");
    }
  }

 private:
  const Mechanism mechanism_;
  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
  std::vector<std::size_t> places_;
  std::vector<double> offsets_;
  mutable std::vector<double> angles_, rates_;
};

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double) {
  // Without these it writes to a file in the working directory.
  mju_user_warning = [](const char* message) { note_complaint(message); };
  mju_user_error = [](const char* message) { throw std::runtime_error(message); };
  return std::make_unique<MujocoEngine>(mechanism, settings);
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"mujoco", mj_versionString(), engines::create}, argc, argv);
}
