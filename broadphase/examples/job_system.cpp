// The library's work on the threads of an engine's own job system.

#include <algorithm>
#include <broadmark/broadphase.hpp>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

namespace bp = broadmark::broadphase;

/// Stands for the engine's job system: threads that take numbered jobs.
class JobSystem {
 public:
  explicit JobSystem(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }
  ~JobSystem() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  /// Runs job(0) to job(count - 1); the caller takes jobs, too. Returns when all are done.
  void parallelFor(int count, const std::function<void(int)>& job) {
    std::unique_lock lock(mutex_);
    job_ = &job;
    next_ = 0;
    count_ = unfinished_ = count;
    wake_.notify_all();
    takeJobs(lock);
    done_.wait(lock, [&] { return unfinished_ == 0; });
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (!ending_) {
      takeJobs(lock);
      wake_.wait(lock, [&] { return ending_ || next_ < count_; });
    }
  }
  void takeJobs(std::unique_lock<std::mutex>& lock) {
    while (next_ < count_) {
      const int i = next_++;
      lock.unlock();
      (*job_)(i);
      lock.lock();
      if (--unfinished_ == 0) done_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(int)>* job_ = nullptr;
  int next_ = 0, count_ = 0, unfinished_ = 0;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

int main() {
  constexpr int kWorkers = 4;
  JobSystem jobs(kWorkers - 1);
  bp::Options options;
  options.threads = kWorkers;
  options.parallel_for = [&](int count, const std::function<void(int)>& job) {
    jobs.parallelFor(count, job);
  };
  bp::BroadPhase broad_phase(options);
  bp::BroadPhase alone;  // one thread, for comparison

  std::mt19937 random(1);
  std::vector<bp::Box> boxes(20'000);
  for (int frame = 0; frame < 5; ++frame) {
    for (bp::Box& box : boxes) {
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<float>(random() % 10'000) * 0.005F;
        box.max[axis] = box.min[axis] + 1;
      }
    }
    broad_phase.update(boxes);
    alone.update(boxes);
    const auto pairs = broad_phase.pairs(), same = alone.pairs();
    std::printf("frame %d: %zu pairs\n", frame, pairs.size());
    // Ascending, so equal for any number of threads.
    if (!std::equal(pairs.begin(), pairs.end(), same.begin(), same.end())) return 1;
  }
}
