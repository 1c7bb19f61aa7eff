// How far a command has come, on a terminal.
#pragma once

#include <string>

namespace mbs {

/// A bar on the terminal's last line, at most once a per cent, that goes when it is destroyed;
/// nothing where standard error is no terminal.
///
///   Progress progress(20.0, "s");
///   progress.at(8.4);     // [########------------]  42 %  8.4 of 20 s
class Progress {
 public:
  Progress(double total, std::string unit);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);

 private:
  double total_;
  std::string unit_;
  bool shown_;
  int percent_ = -1;
};

/// A line of what is being done, over the one before; "" clears it. Nothing where standard error is
/// no terminal.
void show_doing(const std::string& what);

}  // namespace mbs
