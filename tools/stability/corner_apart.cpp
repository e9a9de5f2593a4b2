// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "tools/stability/corner.hpp"
#include "tools/run/interrupt.hpp"
#include "tools/run/seconds_since.hpp"

namespace delf {

namespace {

// What goes through the pipe: numbers as they are, then the reason.
constexpr char started = 's';  // the first byte, before the first step; an answer without it begins with this one:
constexpr char answer = 'a';
struct Numbers {
  int verdict;
  double error_linf, energy_error_max, residual_max, diverged_at, cut_at, seconds;
  std::int64_t steps;
};

void send(int pipe, const CornerResult& r) {
  const Numbers numbers{static_cast<int>(r.verdict),
                        r.error_linf,
                        r.energy_error_max,
                        r.residual_max,
                        r.diverged_at,
                        r.cut_at,
                        r.seconds,
                        r.steps};
  std::string text(1, answer);
  text.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
  text += r.reason;
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(pipe, text.data() + at, text.size() - at);
    if (n <= 0) return;
    at += static_cast<std::size_t>(n);
  }
}

CornerResult received(const std::string& text) {
  Numbers n;
  std::memcpy(&n, text.data(), sizeof n);
  CornerResult r;
  r.verdict = static_cast<CornerVerdict>(n.verdict);
  r.reason = text.substr(sizeof n);
  r.error_linf = n.error_linf, r.energy_error_max = n.energy_error_max, r.residual_max = n.residual_max;
  r.diverged_at = n.diverged_at, r.cut_at = n.cut_at, r.seconds = n.seconds, r.steps = n.steps;
  return r;
}

CornerResult ended(CornerVerdict verdict, const std::string& reason, double seconds) {
  CornerResult r;
  r.verdict = verdict;
  r.reason = reason;
  r.seconds = seconds;
  return r;
}

}  // namespace

CornerResult run_corner_apart(const Corner& corner, double budget) {
  const double to_start = 5 * budget + 1;
  const double patience =
      20 * budget * corner.patience + 40;  // beyond the budget there is one more step, and a look at it
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return run_corner(corner, budget);
  std::fflush(nullptr);  // or the child would write it again
  const pid_t child = fork();
  if (child < 0) {
    close(pipe_ends[0]), close(pipe_ends[1]);
    return run_corner(corner, budget);
  }
  if (child == 0) {
    close(pipe_ends[0]);
    signal(SIGINT, SIG_DFL);
    const int out = pipe_ends[1];
    send(out, run_corner(corner, budget, [out] {
           if (write(out, &started, 1) < 0) _exit(1);
         }));
    _exit(0);
  }
  close(pipe_ends[1]);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return seconds_since(begin); };
  std::string text;
  bool hung = false, late = false;
  while (true) {
    pollfd waiting{pipe_ends[0], POLLIN, 0};
    const int ready = poll(&waiting, 1, 100);
    if (ready > 0) {
      char bytes[4096];
      const ssize_t n = read(pipe_ends[0], bytes, sizeof bytes);
      if (n == 0 || (n < 0 && errno != EINTR)) break;
      if (n > 0) text.append(bytes, static_cast<std::size_t>(n));
    }
    late = text.empty() && elapsed() > to_start;
    hung = elapsed() > patience;
    if (late || hung || Interrupt::asked()) {
      kill(child, SIGKILL);
      break;
    }
  }
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (hung) return ended(CornerVerdict::hung, fmt::format("no answer after {:.3g} s", patience), elapsed());
  if (late) {
    CornerResult r = ended(CornerVerdict::unstarted, fmt::format("no first rows after {:.3g} s", to_start), elapsed());
    r.cut_at = 0;
    return r;
  }
  if (!text.empty() && text.front() == started) text.erase(0, 1);
  if (text.size() > sizeof(Numbers)) return received(text.substr(1));
  if (WIFSIGNALED(status))
    return ended(CornerVerdict::crashed,
                 fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))), elapsed());
  return ended(CornerVerdict::crashed, fmt::format("ended with code {}", WEXITSTATUS(status)), elapsed());
}

}  // namespace delf
