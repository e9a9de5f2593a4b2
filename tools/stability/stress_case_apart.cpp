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

#include "lattice/index.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/stability/stress_case.hpp"

namespace delf {

namespace {

/// A message through the pipe: a mark, numbers as they are, and the reason.
constexpr char on_the_way = 'w', answer = 'a';
struct Numbers {
  int verdict;
  double error_linf, energy_error_max, residual_max, diverged_at, cut_at, seconds;
  std::int64_t steps;
  std::uint64_t reason;  ///< characters of it, which follow
};

void send(int pipe, char mark, const StressResult& r) {
  const Numbers numbers{static_cast<int>(r.verdict),
                        r.error_linf,
                        r.energy_error_max,
                        r.residual_max,
                        r.diverged_at,
                        r.cut_at,
                        r.seconds,
                        r.steps,
                        r.reason.size()};
  std::string text(1, mark);
  text.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
  text += r.reason;
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(pipe, text.data() + at, text.size() - at);
    if (n <= 0) return;
    at += delf::at(n);
  }
}

/// The last result that has come, and its mark.
struct Received {
  char mark = 0;  ///< nothing has come
  StressResult result;
  double at = 0;     ///< seconds from the start
  std::string text;  ///< of which a part may still be to come

  void take(double now) {
    constexpr std::size_t head = 1 + sizeof(Numbers);
    while (text.size() >= head) {
      Numbers n;
      std::memcpy(&n, text.data() + 1, sizeof n);
      if (text.size() < head + n.reason) return;
      mark = text.front(), at = now;
      result.verdict = static_cast<StressVerdict>(n.verdict);
      result.reason = text.substr(head, n.reason);
      result.error_linf = n.error_linf, result.energy_error_max = n.energy_error_max;
      result.residual_max = n.residual_max, result.diverged_at = n.diverged_at, result.cut_at = n.cut_at;
      result.seconds = n.seconds, result.steps = n.steps;
      text.erase(0, head + n.reason);
    }
  }
};

StressResult ended(StressVerdict verdict, const std::string& reason, double seconds) {
  StressResult r;
  r.verdict = verdict;
  r.reason = reason;
  r.seconds = seconds;
  return r;
}

}  // namespace

StressResult run_stress_case_apart(const StressCase& stress_case, double budget) {
  const double to_start = 5 * budget + 1, to_run = budget * stress_case.patience + budget + 1;
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return run_stress_case(stress_case, budget);
  std::fflush(nullptr);  // or the child would write it again
  const pid_t child = fork();
  if (child < 0) {
    close(pipe_ends[0]), close(pipe_ends[1]);
    return run_stress_case(stress_case, budget);
  }
  if (child == 0) {
    close(pipe_ends[0]);
    signal(SIGINT, SIG_DFL);
    const int out = pipe_ends[1];
    send(out, answer, run_stress_case(stress_case, budget, [out](const StressResult& r) { send(out, on_the_way, r); }));
    _exit(0);
  }
  close(pipe_ends[1]);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return seconds_since(begin); };
  Received received;
  double started = 0;
  bool ended_here = false;
  while (true) {
    pollfd waiting{pipe_ends[0], POLLIN, 0};
    const int ready = poll(&waiting, 1, 100);
    if (ready > 0) {
      char bytes[4096];
      const ssize_t n = read(pipe_ends[0], bytes, sizeof bytes);
      if (n == 0 || (n < 0 && errno != EINTR)) break;
      if (n > 0) {
        if (received.mark == 0) started = elapsed();
        received.text.append(bytes, delf::at(n));
        received.take(elapsed());
      }
    }
    ended_here = received.mark == 0 ? elapsed() > to_start : elapsed() > started + to_run;
    if (ended_here || Interrupt::asked()) {
      kill(child, SIGKILL);
      break;
    }
  }
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  StressResult& result = received.result;
  if (received.mark == answer) return result;
  if (ended_here && received.mark == 0) {
    result = ended(StressVerdict::unstarted, fmt::format("no first rows after {:.3g} s", to_start), elapsed());
    result.cut_at = 0;
    return result;
  }
  if (ended_here) {
    constexpr double far_longer = 1e5;
    const double waited = elapsed() - received.at;
    const bool hung = result.steps > 0 && waited * static_cast<double>(result.steps) > far_longer * result.seconds;
    if (hung) return ended(StressVerdict::hung, fmt::format("no answer from a step after {:.3g} s", waited), elapsed());
    result.cut_at = static_cast<double>(result.steps) * stress_case.problem.time_step;
    return result;
  }
  if (WIFSIGNALED(status))
    return ended(StressVerdict::crashed,
                 fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))), elapsed());
  return ended(StressVerdict::crashed, fmt::format("ended with code {}", WEXITSTATUS(status)), elapsed());
}

}  // namespace delf
