// IDA of SUNDIALS: backward differentiation formulas of variable order and step, with KLU and the
// exact sparse matrix of its Newton method, on our equations in natural coordinates.
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "engine.hpp"
#include "ida_problem.hpp"
#include "model_math/extent.hpp"
#include "registry/registry.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

/// Of the harness only scenes are used here: no implementation takes part.
const std::vector<mbs::RegistryEntry>& mbs::registry() {
  static const std::vector<RegistryEntry> none;
  return none;
}

namespace engines {
namespace {

int residual(double, N_Vector y, N_Vector y_rate, N_Vector r, void* problem) {
  static_cast<IdaProblem*>(problem)->residual(NV_DATA_S(y), NV_DATA_S(y_rate), NV_DATA_S(r));
  return 0;
}

int derivative(double, double c, N_Vector y, N_Vector y_rate, N_Vector, SUNMatrix matrix,
               void* problem, N_Vector, N_Vector, N_Vector) {
  auto& of = *static_cast<IdaProblem*>(problem);
  std::ranges::copy(of.pattern().starts(), SM_INDEXPTRS_S(matrix));  // IDA has cleared the matrix
  std::ranges::copy(of.pattern().rows(), SM_INDEXVALS_S(matrix));
  of.derivative(NV_DATA_S(y), NV_DATA_S(y_rate), c, SM_DATA_S(matrix));
  return 0;
}

void complain(int code, const char*, const char*, char* message, void*) {
  if (code < 0) note_complaint(message);
}

void need(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " returned " + std::to_string(flag));
}

struct Release {
  void operator()(_SUNContext* one) const { SUNContext_Free(&one); }
  void operator()(_generic_N_Vector* one) const { N_VDestroy(one); }
  void operator()(_generic_SUNMatrix* one) const { SUNMatDestroy(one); }
  void operator()(_generic_SUNLinearSolver* one) const { SUNLinSolFree(one); }
  void operator()(void* one) const { IDAFree(&one); }
};
template <class Handle>
using Owned = std::unique_ptr<Handle, Release>;

SUNContext create_context() {
  SUNContext made = nullptr;
  need(SUNContext_Create(nullptr, &made), "SUNContext_Create");
  return made;
}

class IdaEngine final : public Engine {
 public:
  IdaEngine(const Mechanism& mechanism, const mbs::Scene& scene, Settings& settings,
            double duration)
      : mechanism_(mechanism),
        problem_(scene.model, settings, duration),
        judged_(mechanism.rods.empty() ? duration / kJudgedOfScene : kJudged),
        context_(create_context()),
        y_(vector()),
        y_rate_(vector()),
        matrix_(SUNSparseMatrix(size(), size(),
                                static_cast<sunindextype>(problem_.pattern().rows().size()),
                                CSC_MAT, context_.get())),
        solver_(SUNLinSol_KLU(y_.get(), matrix_.get(), context_.get())),
        ida_(IDACreate(context_.get())) {
    for (const mbs::Output& one : scene.elements.outputs) {
      const auto points = scene.model.points();
      if (one.kind == mbs::Output::Kind::position && one.point < static_cast<int>(points.size()) &&
          !points[static_cast<std::size_t>(one.point)].is_fixed())
        outputs_.push_back(
            static_cast<std::size_t>(points[static_cast<std::size_t>(one.point)].offset));
    }
    problem_.start(NV_DATA_S(y_.get()), NV_DATA_S(y_rate_.get()));
    void* ida = ida_.get();
    need(IDAInit(ida, residual, 0.0, y_.get(), y_rate_.get()), "IDAInit");
    need(IDASetErrHandlerFn(ida, complain, nullptr), "IDASetErrHandlerFn");
    need(IDASetUserData(ida, &problem_), "IDASetUserData");
    set_tolerances(settings, mbs::extent(scene.model.points()), duration);
    need(IDASetLinearSolver(ida, solver_.get(), matrix_.get()), "IDASetLinearSolver");
    need(IDASetJacFn(ida, derivative), "IDASetJacFn");
    need(SUNLinSol_KLUSetOrdering(solver_.get(), 0), "its ordering");  // AMD
    need(IDASetMaxOrd(ida, static_cast<int>(settings.positive("order", 5))), "its order");
    need(IDASetNonlinConvCoef(ida, settings.positive("newton", 0.33)), "IDASetNonlinConvCoef");
    need(IDASetStopTime(ida, duration), "IDASetStopTime");
    keep_analysis(duration);
  }

  /// Ends with a step of IDA's own: nothing is interpolated.
  double advance(double end) override {
    const double until = std::min(end, (std::floor(reached_ / judged_ + 1e-9) + 1) * judged_);
    while (reached_ < until * (1 - 1e-12)) {
      const int flag = IDASolve(ida_.get(), end, &reached_, y_.get(), y_rate_.get(), IDA_ONE_STEP);
      need(flag, "IDASolve");
    }
    return reached_ > end * (1 - 1e-12) ? end : reached_;
  }

  void read(std::vector<RodState>& states) const override {
    const double *q = NV_DATA_S(y_.get()), *v = q + problem_.coordinates();
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Rod& rod = mechanism_.rods[i];
      double x = rod.anchor, y = 0.0, vx = 0.0, vy = 0.0;
      if (rod.parent >= 0) {
        const std::size_t from = end_of(rod.parent);
        x = q[from], y = q[from + 1], vx = v[from], vy = v[from + 1];
      }
      const std::size_t to = end_of(static_cast<int>(i));
      const double dx = q[to] - x, dy = q[to + 1] - y, dvx = v[to] - vx, dvy = v[to + 1] - vy;
      states[i] = {x + dx / 2,
                   y + dy / 2,
                   dx / rod.length,
                   dy / rod.length,
                   vx + dvx / 2,
                   vy + dvy / 2,
                   (dx * dvy - dy * dvx) / (rod.length * rod.length)};
    }
  }

  void read_points(std::vector<double>& points) const override {
    const double* q = NV_DATA_S(y_.get());
    points.clear();
    for (const std::size_t at : outputs_) points.insert(points.end(), {q[at], q[at + 1]});
  }

 private:
  [[nodiscard]] sunindextype size() const { return static_cast<sunindextype>(problem_.size()); }
  [[nodiscard]] N_Vector vector() const { return N_VNew_Serial(size(), context_.get()); }

  /// KLU analyses the matrix in the first step, and after every start anew; implementations do that
  /// in their set-up, which is not timed. So that step is done here, and what it found is kept.
  void keep_analysis(double stop) {
    const Owned<_generic_N_Vector> y(vector()), y_rate(vector());
    double reached = 0.0;
    need(IDASolve(ida_.get(), stop, &reached, y.get(), y_rate.get(), IDA_ONE_STEP), "IDASolve");
    solver_->ops->initialize = [](SUNLinearSolver) { return SUNLS_SUCCESS; };
    need(IDAReInit(ida_.get(), 0.0, y_.get(), y_rate_.get()), "IDAReInit");
  }

  /// Absolute, in shares of the scene's size for q and of the size over the duration for v: where
  /// the origin lies makes no difference. Multipliers are solved for, and decide nothing: neither a
  /// step's length nor when Newton's method ends.
  void set_tolerances(Settings& settings, double length, double duration) {
    const double accuracy = settings.positive("accuracy", 1e-4);
    const Owned<_generic_N_Vector> absolute(vector()), differential(vector());
    N_VConst(1e30, absolute.get());
    N_VConst(0.0, differential.get());
    const std::size_t n = problem_.coordinates();
    for (std::size_t i = 0; i < 2 * n; ++i) {
      NV_DATA_S(differential.get())[i] = 1.0;
      NV_DATA_S(absolute.get())[i] = accuracy * length / (i < n ? 1.0 : duration);
    }
    need(IDASVtolerances(ida_.get(), 0.0, absolute.get()), "IDASVtolerances");
    need(IDASetId(ida_.get(), differential.get()), "IDASetId");
    need(IDASetSuppressAlg(ida_.get(), 1), "IDASetSuppressAlg");
  }

  /// Where the end of a rod is in q: the free points of the scene are the ends of the first rods,
  /// and the others end at one of them.
  [[nodiscard]] std::size_t end_of(int rod) const {
    if (rod < mechanism_.points) return 2 * static_cast<std::size_t>(rod);
    const auto loop = std::ranges::find(mechanism_.loops, rod, &Loop::rod);
    return 2 * static_cast<std::size_t>(loop->other);
  }

  const Mechanism mechanism_;
  IdaProblem problem_;
  double judged_, reached_ = 0.0;
  Owned<_SUNContext> context_;
  Owned<_generic_N_Vector> y_, y_rate_;
  Owned<_generic_SUNMatrix> matrix_;
  Owned<_generic_SUNLinearSolver> solver_;
  Owned<void> ida_;
  std::vector<std::size_t> outputs_;  // the x of each point in q
};

std::unique_ptr<Engine> create(const Mechanism& mechanism, Settings& settings, double duration) {
  try {
    return std::make_unique<IdaEngine>(mechanism, mbs::load_scene(mechanism.scene), settings,
                                       duration);
  } catch (const mbs::UsageError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace
}  // namespace engines

int main(int argc, char** argv) {
  return engines::run_program({"ida", SUNDIALS_VERSION, engines::create, true}, argc, argv);
}
