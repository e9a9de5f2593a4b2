// SPDX-License-Identifier: MIT
// The module delf._delf: settings, runs in memory, and stepping by hand. The package delf around it is pure Python.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/simulation.hpp"
#include "schemes/start_values.hpp"
#include "tools/commands.hpp"
#include "tools/complex/mesh_run.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/rows/engine.hpp"
#include "tools/run/run_in_memory.hpp"
#include "tools/scene/made_settings.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/shipped_scenes.hpp"
#include "tools/scene/values.hpp"
#include "tools/verify/verify.hpp"
#include "tools/verify/verify_in_memory.hpp"

namespace py = pybind11;

namespace delf {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Keys = std::vector<std::pair<std::string, std::string>>;

void raise(const char* name, const std::exception& error, const std::string& key) {
  std::string line = error_line(error);
  if (line.starts_with("delf: ")) line.erase(0, 6);
  const py::object type = py::module_::import("delf._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(line, key).ptr());
}

void translate(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const BadInput& error) {
    raise("BadInput", error, error.key());
  } catch (const NumericalFailure& error) {
    raise("NumericsFailed", error, "");
  } catch (const SystemFailure& error) {
    raise("SystemFailed", error, "");
  } catch (const std::filesystem::filesystem_error& error) {
    raise("SystemFailed", error, "");
  } catch (const std::bad_alloc& error) {
    raise("SystemFailed", error, "");
  }
}

// An array that owns the values, which nobody writes to any more.
py::array read_only(std::shared_ptr<const std::vector<double>> values, std::vector<py::ssize_t> shape) {
  using Owner = std::shared_ptr<const std::vector<double>>;
  const double* const data = values->data();
  const py::capsule owner(new Owner(std::move(values)), [](void* p) { delete static_cast<Owner*>(p); });
  py::array_t<double> array(std::move(shape), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

std::vector<Setting> settings_in(const Keys& given) {
  std::vector<Setting> keys;
  for (const auto& [key, value] : given) keys.push_back({key, value, 0});
  return keys;
}
// A scene: a file or a shipped name, and keys over it; or keys alone, if there is no file.
Settings settings_of(const std::string& file, const Keys& given) {
  if (!file.empty()) return read_settings(find_scene(file), settings_in(given));
  return made_settings("scene", {}, settings_in(given));
}

const Parameter& known_key(const Settings& settings, const std::string& name) {
  if (const Parameter* key = settings.key(name)) return *key;
  const std::string meant = nearest_key(name, settings.all_keys());
  throw BadInput(name, name + ": unknown key" +
                           (meant.empty() ? "; `delf help run` lists all keys" : "; did you mean " + meant + "?"));
}

std::optional<std::string> value_of(const Settings& settings, const std::string& name) {
  known_key(settings, name);
  return Values(settings).text(name);
}

const char* name_of(KeyType type) {
  switch (type) {
    case KeyType::real:
      return "real";
    case KeyType::integer:
      return "integer";
    case KeyType::toggle:
      return "toggle";
    case KeyType::choice:
      return "choice";
    case KeyType::text:
      return "text";
  }
  return "";
}

py::dict dict_of(const Parameter& key) {
  py::dict d;
  d["name"] = key.key, d["type"] = name_of(type_of(key)), d["default"] = fallback_of(key),
  d["otherwise"] = key.otherwise;
  d["meaning"] = key.help, d["unit"] = key.unit, d["choices"] = key.choices;
  return d;
}

template <class Keys>
py::list list_of(const Keys& keys) {
  py::list all;
  for (const Parameter& key : keys) all.append(dict_of(key));
  return all;
}

// While it lives, runs of this thread show no progress, and Ctrl-C asks for their end, if Python would tell this thread.
class InPython {
 public:
  explicit InPython(bool main_thread) : main_thread_(main_thread) {
    Progress::silent = true;
    Interrupt::forget(main_thread);
    if (main_thread) interrupt_.emplace();
  }
  ~InPython() {
    interrupt_.reset();
    Interrupt::forget(main_thread_);
    Progress::silent = false;
  }
  InPython(const InPython&) = delete;
  InPython& operator=(const InPython&) = delete;

 private:
  bool main_thread_;
  std::optional<Interrupt> interrupt_;
};

// The recorded rows of a run: each where it stays, so that arrays may refer to it.
class Kept {
 public:
  using Row = std::shared_ptr<const std::vector<double>>;

  void begin(const RowNames& names, std::uint64_t records_before) { names_ = names, records_before_ = records_before; }
  /// Of the run that this one goes on from: so many of its records are in front of these.
  std::uint64_t records_before() const { return records_before_; }
  void see(const Record& r, const RecordedRow& row, const RecordedDatasets& datasets) {
    for (const double value : {static_cast<double>(r.row), r.time, r.energy, r.energy_error, r.momentum, r.charge,
                               static_cast<double>(r.iterations), r.residual})
      series_.push_back(value);
    series_.insert(series_.end(), r.further.begin(), r.further.end());
    ++frames_;
    for (const Role role : all_roles)
      if (!names_.of[role].empty()) keep(delf::to_string(role), row[role]);
    for (std::size_t d = 0; d < datasets.size(); ++d) keep(names_.datasets[d].name, datasets[d]);
  }
  py::array newest_field() const {
    const Row& row = rows_.at("field").back();
    return read_only(row, shape_of("field", *row));
  }

  py::list series_names() const {
    py::list names;
    for (const char* name : {"step", "time", "energy", "energy_error", "momentum", "charge", "iterations", "residual"})
      names.append(name);
    for (const std::string& name : names_.further) names.append(name);
    return names;
  }
  /// records × columns
  py::array series() const {
    const auto columns = static_cast<py::ssize_t>(8 + names_.further.size());
    return read_only(std::make_shared<std::vector<double>>(series_), {frames_, frames_ == 0 ? 0 : columns});
  }
  /// frames × sites × components of each dataset
  py::dict rows() const {
    py::dict all;
    for (const auto& [name, rows] : rows_) {
      auto joined = std::make_shared<std::vector<double>>();
      for (const Row& row : rows) joined->insert(joined->end(), row->begin(), row->end());
      std::vector<py::ssize_t> shape = shape_of(name, *rows.front());
      shape.insert(shape.begin(), static_cast<py::ssize_t>(rows.size()));
      all[name.c_str()] = read_only(joined, shape);
    }
    return all;
  }
  py::dict components() const {
    py::dict all;
    for (const Role role : all_roles)
      if (!names_.of[role].empty()) all[delf::to_string(role)] = names_.of[role];
    for (const auto& dataset : names_.datasets) all[dataset.name.c_str()] = dataset.components;
    return all;
  }

 private:
  void keep(const std::string& name, const std::vector<double>& row) {
    rows_[name].push_back(std::make_shared<const std::vector<double>>(row));
  }
  std::vector<py::ssize_t> shape_of(const std::string& name, const std::vector<double>& row) const {
    std::size_t columns = 1;
    for (const Role role : all_roles)
      if (name == delf::to_string(role)) columns = std::max<std::size_t>(1, names_.of[role].size());
    for (const auto& dataset : names_.datasets)
      if (name == dataset.name) columns = std::max<std::size_t>(1, dataset.components.size());
    return {static_cast<py::ssize_t>(row.size() / columns), static_cast<py::ssize_t>(columns)};
  }

  RowNames names_;
  std::uint64_t records_before_ = 0;
  py::ssize_t frames_ = 0;
  std::vector<double> series_;
  std::map<std::string, std::vector<Row>> rows_;
};

// The Python exception of a failure, or None.
py::object exception_of(const std::exception_ptr& failure) {
  if (!failure) return py::none();
  translate(failure);
  return py::error_already_set().value();
}

// Runs a scene on a lattice. `at_record` gets (row, time, energy, field) and ends the run by returning True. With the
// `state` of an earlier run it goes on from there.
py::dict run_scene(const Settings& settings, const std::string& name, const py::object& at_record, bool main_thread,
                   const std::string& state) {
  Kept kept;
  RunInMemory result;
  Scene scene = read_scene(settings);
  if (!name.empty()) scene.name = name;
  scene.figures = false;
  std::exception_ptr in_callback;
  bool stopped = false;
  const auto see = [&](const Record& r, const RecordedRow& row, const RecordedDatasets& datasets) {
    kept.see(r, row, datasets);
    if (at_record.is_none() || stopped) return;
    const py::gil_scoped_acquire python;
    try {
      stopped = py::bool_(at_record(r.row, r.time, r.energy, kept.newest_field()));
    } catch (...) {
      in_callback = std::current_exception(), stopped = true;
    }
    if (stopped) Interrupt::ask_here();
  };
  bool interrupted = false;
  {
    const py::gil_scoped_release others_may_go_on;
    const InPython here(main_thread);
    const auto begin = [&](const RowNames& names, std::uint64_t before) { kept.begin(names, before); };
    result = run_in_memory(scene, state, {begin, see});
    interrupted = result.status == "interrupted" && !stopped;
  }
  if (in_callback) std::rethrow_exception(in_callback);
  py::dict d;
  d["status"] = stopped && result.status == "interrupted" ? "stopped" : result.status;
  d["interrupted"] = interrupted;
  d["summary"] = result.summary, d["report"] = result.report, d["scene"] = result.scene;
  d["section"] = result.section, d["warnings"] = scene.warnings;
  d["series_names"] = kept.series_names(), d["series"] = kept.series();
  d["rows"] = kept.rows(), d["components"] = kept.components();
  d["records_before"] = kept.records_before(), d["state"] = py::bytes(result.state);
  std::vector<double> space;
  for (int i = 0; i < scene.problem.lattice.sites(); ++i) space.push_back(scene.problem.lattice.position(i));
  const auto sites = static_cast<py::ssize_t>(space.size());
  d["space"] = read_only(std::make_shared<std::vector<double>>(std::move(space)), {sites});
  d["failure"] = exception_of(result.failure);
  return d;
}

// Checks the rows of a scene on a lattice, or those of a file.
py::dict verify_scene(Settings settings, const std::string& name, const std::optional<std::string>& fields,
                      const std::vector<std::string>& nearby, bool main_thread) {
  if (fields) imply_rows(settings, *fields);
  Scene scene = read_scene(std::move(settings));
  if (!name.empty()) scene.name = name;
  VerifyInMemory result;
  {
    const py::gil_scoped_release others_may_go_on;
    const InPython here(main_thread);
    result = verify_in_memory(scene, fields, nearby);
  }
  py::dict d;
  d["status"] = result.status, d["report"] = result.report, d["json"] = result.json, d["passed"] = result.passed;
  d["warnings"] = scene.warnings, d["failure"] = exception_of(result.failure);
  return d;
}

// A scheme on a lattice, stepped by hand. Every call waits for the one before it, without the interpreter's lock.
class HandEvolution {
 public:
  HandEvolution(const Settings& settings, int winding) : scene_(read_scene(settings)) {
    scene_.problem.winding = winding;
    const py::gil_scoped_release others_may_go_on;
    simulation_ = std::make_unique<Simulation>(build(scene_, winding));
    delf::require_determined(scene_, *simulation_);
  }

  /// Row 0 and its rate, of the fields or of all components; of a density that is linear in φ_t row 0 alone.
  void start(const Array& row0, const Array& velocity) {
    const std::vector<double> y = complete(row0), v = complete(velocity);
    const Scope scope(*this);
    ++moves_;
    if (may_start_from_values(scene_.problem) && simulation_->starting_rows() > 1)
      start_from_values(*simulation_, y, monodromy_of(scene_.problem));
    else if (starts_with(StartRule::centred)) simulation_->start_centred(y, v);
    else simulation_->start_legendre(y, v);
    started_ = true;
  }
  void start_rows(const std::vector<Array>& rows) {
    std::vector<std::vector<double>> all;
    for (const Array& row : rows) all.push_back(complete(row));
    const Scope scope(*this);
    if (static_cast<int>(all.size()) != simulation_->starting_rows())
      throw BadInput("", "start_rows: this scheme starts from " + std::to_string(simulation_->starting_rows()) +
                             " rows, and " + std::to_string(all.size()) + " are given");
    ++moves_;
    simulation_->start(all);
    started_ = true;
  }

  /// So many steps. Python's signals are handled ten times a second.
  void step(std::int64_t count) {
    if (count < 0) throw BadInput("", "step: the number of steps is negative; give 0 or more");
    require_start();
    std::int64_t batch = 1;
    if (count == 1) {  // nothing is handled on the way
      const Scope scope(*this);
      ++moves_;
      return simulation_->step();
    }
    while (count > 0) {
      {
        const Scope scope(*this);
        const auto begin = std::chrono::steady_clock::now();
        const auto now = static_cast<int>(std::min(batch, count));
        ++moves_;
        if (now > 1) simulation_->steps(now - 1);
        simulation_->step();
        count -= now;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        batch = took.count() < 0.05 ? std::min<std::int64_t>(2 * batch, 1 << 30) : std::max<std::int64_t>(1, batch / 2);
      }
      if (count > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

  /// The fields of a row, sites × fields: a view of memory that later steps leave alone, as it belongs to the row and its
  /// views. (In the engine sites are not in their order.) Memory that nobody views is used again.
  py::array row(int back) {
    require_start();
    if (back < 0 || back >= std::max(2, simulation_->starting_rows()))
      throw BadInput("", "row: back = " + std::to_string(back) + " is not held; give 0 to " +
                             std::to_string(std::max(2, simulation_->starting_rows()) - 1));
    RowMemory& known = rows_[back];
    if (!known.values || known.moves != moves_) {
      RowMemory next{unviewed(), 0};
      double* const values = static_cast<double*>(const_cast<void*>(next.values->data()));
      {
        std::unique_lock lock(busy_, std::try_to_lock);
        std::optional<py::gil_scoped_release> others_may_go_on;
        if (constexpr py::ssize_t many = 1 << 16; !lock || next.values->size() > many) others_may_go_on.emplace();
        if (!lock) lock.lock();
        next.moves = moves_;
        simulation_->observe(back, {values, at(next.values->size())});
        lock.unlock();
      }
      std::swap(known, next);
      spare_ = std::move(next.values);
    }
    const py::array& values = *known.values;
    return {values.dtype(), {values.shape(), values.shape() + values.ndim()}, {}, values.data(), values};
  }

  std::int64_t newest() {
    return started_ ? ask([](Simulation& s) { return s.newest(); }) : -1;
  }
  double time() {
    require_start();
    return ask([](Simulation& s) { return s.time(s.newest()); });
  }
  double residual() {
    require_start();
    return ask([](Simulation& s) { return s.residual(); });
  }
  int iterations() {
    return ask([](Simulation& s) { return s.iterations(); });
  }
  py::dict monitors() {
    require_start();
    const auto m = ask([](Simulation& s) { return s.monitors(); });
    py::dict d;
    d["energy"] = m.energy, d["momentum"] = m.momentum, d["charge"] = m.charge, d["constraint"] = m.constraint;
    for (std::size_t i = 0; i < m.conserved.size(); ++i) d[simulation_->conserved_names()[i].c_str()] = m.conserved[i];
    return d;
  }
  py::array momenta(int back) {
    require_start();
    auto p = std::make_shared<std::vector<double>>(ask([&](Simulation& s) { return s.momenta(back); }));
    return read_only(p, {sites(), static_cast<py::ssize_t>(simulation_->components().size())});
  }
  std::string plan() const { return simulation_->plan_report(); }
  std::string solve() const { return simulation_->solve_summary(); }
  std::vector<std::string> component_names() const {
    std::vector<std::string> names;
    for (const Component& c : simulation_->components()) names.push_back(c.name);
    return names;
  }
  py::array positions() const {
    auto x = std::make_shared<std::vector<double>>();
    for (int i = 0; i < scene_.problem.lattice.sites(); ++i) x->push_back(scene_.problem.lattice.position(i));
    return read_only(x, {sites()});
  }
  py::ssize_t sites() const { return scene_.problem.lattice.sites(); }
  py::ssize_t fields() const { return simulation_->count(Role::field); }
  double time_step() const { return scene_.problem.time_step; }

 private:
  // Other Python threads go on while one waits for, or works with, the rows.
  class Scope {
   public:
    explicit Scope(HandEvolution& of) : lock_(of.busy_) {}

   private:
    py::gil_scoped_release others_may_go_on_;
    std::lock_guard<std::mutex> lock_;
  };

  template <class Question>
  std::invoke_result_t<Question, Simulation&> ask(const Question& question) {
    const Scope scope(*this);
    return question(*simulation_);
  }
  // Memory for a row that Python cannot write to, and no array views.
  std::optional<py::array> unviewed() {
    if (auto memory = std::exchange(spare_, {}); memory && memory->ref_count() == 1) return memory;
    std::vector<py::ssize_t> shape{sites()};
    if (fields() != 1) shape.push_back(fields());
    py::array_t<double> memory(std::move(shape));
    py::detail::array_proxy(memory.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return memory;
  }
  void require_start() const {
    if (!started_) throw BadInput("", "a step needs rows to go on from: call start(y0, v0) first");
  }
  bool starts_with(StartRule rule) const {
    const auto& starts = find_method(scene_.problem.method).starts;
    return std::ranges::find(starts, rule) != starts.end();
  }
  // The entries of multipliers are not read; other components must be given.
  std::vector<double> complete(const Array& row) const {
    const std::size_t n = at(sites()), all = simulation_->components().size();
    const std::size_t given = row.size();
    if (given == n * all) return {row.data(), row.data() + given};
    const std::size_t d = at(fields());
    const bool rest_is_multipliers = d + at(simulation_->count(Role::multiplier)) == all;
    if (given != n * d || !rest_is_multipliers)
      throw BadInput("", "a row has " + std::to_string(given) + " values, and " + std::to_string(n) + " sites with " +
                             std::to_string(rest_is_multipliers ? d : all) + " values each are needed");
    std::vector<double> values(n * all, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t a = 0; a < d; ++a) values[i * all + a] = row.data()[i * d + a];
    return values;
  }

  Scene scene_;
  std::unique_ptr<Simulation> simulation_;
  std::mutex busy_;
  std::atomic<bool> started_ = false;
  std::atomic<std::uint64_t> moves_ = 0;  ///< starts and steps
  /// A row as it was after so many moves; nothing writes to it any more. It belongs to the interpreter's lock.
  struct RowMemory {
    std::optional<py::array> values;
    std::uint64_t moves = 0;
  };
  std::array<RowMemory, 8> rows_;
  std::optional<py::array> spare_;
};

}  // namespace
}  // namespace delf

PYBIND11_MODULE(_delf, m) {
  using namespace delf;
  m.doc() = "The engine of delf; use the package delf.";
  py::register_exception_translator(translate);
  m.attr("version") = DELF_VERSION;
  m.def(
      "keys", [] { return list_of(keys()); }, "Every key that `delf help run` lists, as dictionaries.");
  m.def("scenes", [] {
    py::list all;
    for (const ShippedScene& s : shipped_scenes()) all.append(py::make_tuple(s.name, s.file.string(), s.title));
    return all;
  });
  m.def("keys_of_other_commands", [](const std::string& command, const Keys& given) {
    return keys_of_other_commands(command, settings_in(given));
  });
  m.def("find_scene", [](const std::string& name) { return find_scene(name).string(); });

  py::class_<Settings>(m, "Settings", "A scene as text: a file or a shipped name, and keys over it.")
      .def(py::init(&settings_of), py::arg("file"), py::arg("given"))
      .def("value", &value_of, py::arg("key"), "The text in force, or None.")
      .def(
          "check",
          [](const Settings& s) {
            AnyScene any = read_any_scene(s);
            return std::visit([](auto& scene) { return common_part(scene).warnings; }, any);
          },
          "Reads all values. Raises BadInput; returns warnings.")
      .def("keys", [](const Settings& s) { return list_of(s.all_keys()); })
      .def("place", &Settings::place, py::arg("key"))
      .def_property_readonly("on_mesh", [](const Settings& s) { return is_on_mesh(s); })
      .def_property_readonly("given", [](const Settings& s) {
        py::dict d;
        for (auto one = s.all().rbegin(); one != s.all().rend(); ++one) d[one->key.c_str()] = one->value;
        return d;
      });
  m.def("run", &run_scene, py::arg("settings"), py::arg("name"), py::arg("at_record"), py::arg("main_thread"),
        py::arg("state"));
  m.def("verify", &verify_scene, py::arg("settings"), py::arg("name"), py::arg("fields"), py::arg("nearby"),
        py::arg("main_thread"));

  py::class_<HandEvolution>(m, "Evolution", "A scheme on a lattice, stepped by hand.")
      .def(py::init<const Settings&, int>(), py::arg("settings"), py::arg("winding") = 0)
      .def("start", &HandEvolution::start, py::arg("row0"), py::arg("velocity"))
      .def("start_rows", &HandEvolution::start_rows, py::arg("rows"))
      .def("step", &HandEvolution::step, py::arg("count") = 1)
      .def("row", &HandEvolution::row, py::arg("back") = 0)
      .def("momenta", &HandEvolution::momenta, py::arg("back") = 0)
      .def("monitors", &HandEvolution::monitors)
      .def_property_readonly("newest", &HandEvolution::newest)
      .def_property_readonly("time", &HandEvolution::time)
      .def_property_readonly("residual", &HandEvolution::residual)
      .def_property_readonly("iterations", &HandEvolution::iterations)
      .def_property_readonly("plan", &HandEvolution::plan)
      .def_property_readonly("solve", &HandEvolution::solve)
      .def_property_readonly("components", &HandEvolution::component_names)
      .def_property_readonly("x", &HandEvolution::positions)
      .def_property_readonly("time_step", &HandEvolution::time_step);
}
