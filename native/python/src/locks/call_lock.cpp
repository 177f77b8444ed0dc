// SPDX-License-Identifier: Apache-2.0
#include "call_lock.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#if !defined(_WIN32)
#include <pthread.h>
#endif

#include "signals.h"

namespace limitsurf::python {
namespace {

using Access = CallLock::Access;
using Thread = std::uint64_t;

/// The time between two looks for Ctrl-C while a call waits.
constexpr std::chrono::milliseconds kLook{50};

Thread thisThread() {
  static std::atomic<Thread> count{0};
  static thread_local const Thread number = ++count;
  return number;
}

struct Held {
  const CallLock* lock;
  Access access;
  Thread thread;
  bool lost = false;  ///< by a thread of the process from which this one was forked
};

struct Waiting {
  const CallLock* lock;
  Access access;
  Thread thread;
  bool in_turn;            ///< whether it lets those that came before it go first
  bool suspended = false;  ///< while the thread looks for Ctrl-C
};

/// All calls that hold locks or wait for them, in the order in which they came. There are about as
/// many as threads, so that the lists are searched from end to end.
class Table {
 public:
  static Table& instance() {
    // It is never destroyed: threads may still be under way when the process ends.
    static Table* const table = new Table;
    return *table;
  }

  /// Whether the thread's next request waits for its turn: not if others may be waiting for what
  /// the thread already holds.
  bool inTurn() {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto is_mine = [me = thisThread()](const auto& entry) { return entry.thread == me; };
    return std::none_of(held_.begin(), held_.end(), is_mine) &&
           std::none_of(waiting_.begin(), waiting_.end(), is_mine);
  }

  void acquire(const CallLock& lock, Access access, bool in_turn) {
    std::unique_lock<std::mutex> guard(mutex_);
    const Thread me = thisThread();
    const auto place = waiting_.insert(waiting_.end(), {&lock, access, me, in_turn});
    try {
      await(place, guard);
    } catch (...) {
      leave(place);
      throw;
    }
    held_.push_back({&lock, access, me});
    leave(place);
  }

  void release(const CallLock& lock) {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto last = std::find_if(held_.rbegin(), held_.rend(), [&](const Held& held) {
      return held.lock == &lock && held.thread == thisThread();
    });
    held_.erase(std::next(last).base());
    changed_->notify_all();
  }

  void forget(const CallLock& lock) {
    const std::lock_guard<std::mutex> guard(mutex_);
    held_.erase(std::remove_if(held_.begin(), held_.end(),
                               [&](const Held& held) { return held.lock == &lock; }),
                held_.end());
  }

 private:
  using Queue = std::list<Waiting>;
  using Place = Queue::iterator;

  Table() {
#if !defined(_WIN32)
    pthread_atfork([] { instance().mutex_.lock(); }, [] { instance().mutex_.unlock(); },
                   [] { instance().beginInChild(); });
#endif
  }

  /// Only the thread that has forked goes on here.
  void beginInChild() {
    for (Held& held : held_) {
      held.lost = held.lost || held.thread != thisThread();
    }
    waiting_.remove_if([](const Waiting& request) { return request.thread != thisThread(); });
    changed_ = new std::condition_variable;  // threads wait for the other one that do not exist
    mutex_.unlock();
  }

  /// Waits until the request can be granted. Throws if it never can, or what Ctrl-C raises; the
  /// mutex is held then, too.
  void await(Place request, std::unique_lock<std::mutex>& guard) {
    while (!blocking(request).empty()) {
      refuseForever(request);
      if (changed_->wait_for(guard, kLook) == std::cv_status::timeout) {
        request->suspended = true;
        guard.unlock();
        try {
          lookForSignals();
        } catch (...) {
          guard.lock();
          throw;
        }
        guard.lock();
        request->suspended = false;
      }
    }
  }

  void leave(Place request) {
    waiting_.erase(request);
    if (!waiting_.empty()) {
      changed_->notify_all();
    }
  }

  struct Blocking {
    Thread thread;
    bool lost;
  };

  /// The threads for which a request has to wait.
  std::vector<Blocking> blocking(Queue::const_iterator request) const {
    std::vector<Blocking> threads;
    const auto conflict = [&](const auto& other) {
      return other.lock == request->lock &&
             (other.access == Access::change || request->access == Access::change);
    };
    for (const Held& held : held_) {
      if (conflict(held)) {
        threads.push_back({held.thread, held.lost});
      }
    }
    for (auto earlier = waiting_.begin(); request->in_turn && earlier != request; ++earlier) {
      if (conflict(*earlier)) {
        threads.push_back({earlier->thread, false});
      }
    }
    return threads;
  }

  /// Throws if the request waits for a thread that waits for it, or for one that does not exist.
  void refuseForever(Queue::const_iterator first) const {
    const std::string what = first->lock->what();
    std::set<Thread> seen;
    std::vector<Queue::const_iterator> open{first};
    while (!open.empty()) {
      const auto request = open.back();
      open.pop_back();
      for (const Blocking& other : blocking(request)) {
        if (other.lost) {
          throw std::runtime_error(
              "a thread of the parent process was using this " + what +
              " when this process was forked: it can no longer be used here in this way. Start "
              "child processes by spawn or forkserver instead");
        }
        if (other.thread == first->thread) {
          throw std::runtime_error(
              "this " + what +
              " is in use by a call that has itself called this function, for example a density or "
              "progress function, a signal handler or a destructor: the call would wait for "
              "itself");
        }
        if (!seen.insert(other.thread).second) {
          continue;
        }
        for (auto wait = waiting_.begin(); wait != waiting_.end(); ++wait) {
          if (wait->thread == other.thread && !wait->suspended) {
            open.push_back(wait);
          }
        }
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable* changed_ = new std::condition_variable;
  std::vector<Held> held_;
  Queue waiting_;
};

}  // namespace

CallLock::~CallLock() { Table::instance().forget(*this); }

void CallLock::mendIfBroken() const {
  if (is_whole_) {
    return;
  }
  const Hold alone(*this, Access::change);
  if (!is_whole_) {  // nobody else has done it meanwhile
    const InterruptionPoint point = interruptible();
    mend_();
    is_whole_ = true;
  }
}

CallLock::Hold::Hold(const CallLock& lock, Access access) : lock_(lock) {
  Table& table = Table::instance();
  const bool in_turn = table.inTurn();
  table.acquire(lock, access, in_turn);
  while (access == Access::read && !lock.is_whole_) {
    table.release(lock);
    lock.mendIfBroken();
    table.acquire(lock, access, in_turn);
  }
}

CallLock::Hold::~Hold() { Table::instance().release(lock_); }

// The one with the smaller address comes first: otherwise two calls could wait for each other.
CallLock::HoldTwo::HoldTwo(const CallLock& a, const CallLock& b)
    : first_(std::less<>()(&b, &a) ? b : a), second_(std::less<>()(&b, &a) ? a : b) {
  do {
    first_.mendIfBroken();
    second_.mendIfBroken();
    acquire();
  } while (!isWhole());
}

CallLock::HoldTwo::~HoldTwo() { release(); }

void CallLock::HoldTwo::acquire() {
  Table& table = Table::instance();
  const bool in_turn = table.inTurn();
  table.acquire(first_, Access::read, in_turn);
  if (&first_ != &second_) {
    try {
      table.acquire(second_, Access::read, in_turn);
    } catch (...) {
      table.release(first_);
      throw;
    }
  }
}

void CallLock::HoldTwo::release() {
  if (&first_ != &second_) {
    Table::instance().release(second_);
  }
  Table::instance().release(first_);
}

bool CallLock::HoldTwo::isWhole() {
  if (first_.is_whole_ && second_.is_whole_) {
    return true;
  }
  release();
  return false;
}

}  // namespace limitsurf::python
