// SPDX-License-Identifier: Apache-2.0
//
// What libFuzzer calls to fuzz the Python module: a Python interpreter that hands each input to
// pickle_target.py. The module is compiled with the sanitizers and reports its coverage; Python and
// numpy are not. PYTHONPATH names the folders of the module and of the target.
#include <pybind11/embed.h>

#include <cstddef>
#include <cstdint>

namespace {

namespace py = pybind11;

py::object& target() {
  // Never destroyed: the fuzzer ends the process without ending Python.
  static py::object& function = *new py::object;
  return function;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerInitialize(int*, char***) {
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  PyConfig_SetBytesString(&config, &config.executable, LIMITSURF_PYTHON);
  config.install_signal_handlers = 0;  // libFuzzer has its own
  config.parse_argv = 0;
  py::initialize_interpreter(&config);
  target() = py::module_::import("pickle_target").attr("pickle_target");
  return 0;
}

// An error of Python is an exception that nobody catches: it ends the fuzzer as a finding.
extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(
    const std::uint8_t* data, std::size_t size) {
  target()(py::bytes(reinterpret_cast<const char*>(data), size));
  return 0;
}
