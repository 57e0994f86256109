// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The part of oneTBB that the project uses, on std::thread. A build for ThreadSanitizer uses these headers
// instead of oneTBB's, because oneTBB's library is compiled without the sanitizer, which would not see how
// its threads wait for each other. A loop starts its threads and joins them; nothing else orders their work.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

/// Limits the threads of all loops while it lives.
class global_control {
 public:
  enum parameter { max_allowed_parallelism };

  global_control(parameter, std::size_t limit) : limit_(limit) {
    const std::lock_guard lock(mutex());
    limits().insert(limit);
  }
  ~global_control() {
    const std::lock_guard lock(mutex());
    limits().erase(limits().find(limit_));
  }
  global_control(const global_control&) = delete;
  global_control(global_control&&) = delete;
  global_control& operator=(const global_control&) = delete;
  global_control& operator=(global_control&&) = delete;

  static std::size_t active_value(parameter) {
    const std::lock_guard lock(mutex());
    return limits().empty() ? default_threads() : *limits().begin();
  }

 private:
  friend class task_arena;

  /// At least four, to have several threads on small machines, too.
  static std::size_t default_threads() { return std::max(4U, std::thread::hardware_concurrency()); }
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::multiset<std::size_t>& limits() {
    static std::multiset<std::size_t> limits;
    return limits;
  }

  std::size_t limit_;
};

/// Whether a loop continues. Belongs to the loop in which it was made.
class task_group_context {
 public:
  task_group_context();
  bool is_group_execution_cancelled() const {
    return cancelled_ || (outer_ != nullptr && outer_->is_group_execution_cancelled());
  }
  bool cancel_group_execution() { return !cancelled_.exchange(true); }

 private:
  std::atomic<bool> cancelled_ = false;
  task_group_context* outer_;
};

namespace detail {

/// Threads that an arena may still start.
using Free = std::atomic<int>;

/// The context of the current thread's work.
struct State {
  task_group_context* context = nullptr;
  int concurrency = 0;  ///< of the arena; 0 outside of arenas
  Free* free = nullptr;
};
inline thread_local State state;

/// Sets the state of the current thread while it lives.
class Within {
 public:
  explicit Within(State inside) : outside_(std::exchange(state, inside)) {}
  ~Within() { state = outside_; }
  Within(const Within&) = delete;
  Within(Within&&) = delete;
  Within& operator=(const Within&) = delete;
  Within& operator=(Within&&) = delete;

 private:
  State outside_;
};

}  // namespace detail

inline task_group_context::task_group_context() : outer_(detail::state.context) {}

inline bool is_current_task_group_canceling() {
  return detail::state.context != nullptr && detail::state.context->is_group_execution_cancelled();
}

struct task {
  static task_group_context* current_context() { return detail::state.context; }
};

namespace this_task_arena {
inline int max_concurrency() {
  const int own = detail::state.concurrency;
  return own > 0 ? own
                 : static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}
}  // namespace this_task_arena

/// A number of threads for the loops in the functions that it executes.
class task_arena {
 public:
  static constexpr int automatic = -1;

  explicit task_arena(int threads = automatic)
      : threads_(threads > 0 ? threads
                             : static_cast<int>(
                                   global_control::active_value(global_control::max_allowed_parallelism))) {}

  template <class Work>
  auto execute(const Work& work) {
    detail::Free free = threads_ - 1;
    const detail::Within within({nullptr, threads_, &free});
    return work();
  }

 private:
  int threads_;
};

template <class Number>
class blocked_range {
 public:
  blocked_range(Number begin, Number end) : begin_(begin), end_(end) {}
  Number begin() const { return begin_; }
  Number end() const { return end_; }

 private:
  Number begin_, end_;
};

struct auto_partitioner {};
/// Each thread gets one range of the loop, by its number.
struct static_partitioner {};

namespace detail {

/// The threads of one loop.
class Team {
 public:
  Team(task_group_context& context, std::ptrdiff_t pieces) : context_(context) {
    const auto allowed = std::min<std::ptrdiff_t>(
        static_cast<std::ptrdiff_t>(global_control::active_value(global_control::max_allowed_parallelism)),
        this_task_arena::max_concurrency());
    const int wanted = static_cast<int>(std::min(allowed, pieces)) - 1;
    while (helpers_ < wanted && (state.free == nullptr || take_one())) ++helpers_;
  }

  [[nodiscard]] int size() const { return helpers_ + 1; }

  /// Calls `work(t)` for each thread t of the team, and throws what one of them throws.
  template <class Work>
  void run(const Work& work) {
    const auto guarded = [&](int t) {
      State inside = state;
      inside.context = &context_;
      const Within within(inside);
      try {
        work(t);
      } catch (...) {
        if (context_.cancel_group_execution()) error_ = std::current_exception();
      }
    };
    std::vector<std::thread> threads;
    for (int t = 1; t <= helpers_; ++t) {
      threads.emplace_back([&guarded, t, outside = state] {
        const Within within(outside);
        guarded(t);
      });
    }
    guarded(0);
    for (std::thread& thread : threads) thread.join();
    if (state.free != nullptr) *state.free += helpers_;
    if (error_) std::rethrow_exception(error_);
  }

 private:
  static bool take_one() {
    int free = *state.free;
    while (free > 0) {
      if (state.free->compare_exchange_weak(free, free - 1)) return true;
    }
    return false;
  }

  task_group_context& context_;
  int helpers_ = 0;
  std::exception_ptr error_;
};

}  // namespace detail

template <class Number, class Body>
void parallel_for(const blocked_range<Number>& range, const Body& body, static_partitioner,
                  task_group_context& context) {
  const auto n = static_cast<std::ptrdiff_t>(range.end() - range.begin());
  if (n <= 0 || context.is_group_execution_cancelled()) return;
  detail::Team team(context, n);
  const std::ptrdiff_t size = team.size();
  team.run([&](std::ptrdiff_t t) {
    const auto from = static_cast<Number>(range.begin() + n * t / size);
    const auto to = static_cast<Number>(range.begin() + n * (t + 1) / size);
    if (from < to && !context.is_group_execution_cancelled()) body(blocked_range<Number>(from, to));
  });
}

template <class Number, class Body>
void parallel_for(const blocked_range<Number>& range, const Body& body, task_group_context& context) {
  const auto n = static_cast<std::ptrdiff_t>(range.end() - range.begin());
  if (n <= 0 || context.is_group_execution_cancelled()) return;
  detail::Team team(context, n);
  // Pieces are assigned in turn, not taken: each thread has its share even if the machine runs one thread at
  // a time.
  const std::ptrdiff_t piece = std::max<std::ptrdiff_t>(1, n / (8 * team.size()));
  team.run([&](std::ptrdiff_t t) {
    for (std::ptrdiff_t from = t * piece; from < n; from += team.size() * piece) {
      if (context.is_group_execution_cancelled()) return;
      body(blocked_range<Number>(static_cast<Number>(range.begin() + from),
                                 static_cast<Number>(range.begin() + std::min(n, from + piece))));
    }
  });
}

template <class Number, class Body>
void parallel_for(Number first, Number last, const Body& body) {
  task_group_context context;
  parallel_for(
      blocked_range<Number>(first, last),
      [&](const blocked_range<Number>& some) {
        for (Number i = some.begin(); i < some.end(); ++i) body(i);
      },
      context);
}

/// A value for each thread that asks for it.
template <class Value>
class enumerable_thread_specific {
 public:
  template <class Make>
  explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

  Value& local() {
    const std::lock_guard lock(mutex_);
    const auto id = std::this_thread::get_id();
    auto found = values_.find(id);
    if (found == values_.end()) found = values_.emplace(id, make_()).first;
    return found->second;
  }

 private:
  std::function<Value()> make_;
  std::mutex mutex_;
  std::map<std::thread::id, Value> values_;
};

}  // namespace tbb
