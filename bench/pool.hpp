// SPDX-License-Identifier: MIT
// A pool of threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

/// Threads that wait for work, as a renderer has them. Serves one call at a time.
class Pool {
public:
    explicit Pool(std::size_t threads) {
        for (std::size_t i = 0; i < threads; ++i)
            threads_.emplace_back([this] { serve(); });
    }
    ~Pool() {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        more_.notify_all();
        for (std::thread& thread : threads_)
            thread.join();
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    void operator()(std::size_t n, const std::function<void(std::size_t)>& body) {
        std::unique_lock lock(mutex_);
        body_ = &body;
        next_ = 0;
        count_ = left_ = n;
        more_.notify_all();
        done_.wait(lock, [this] { return left_ == 0; });
    }

private:
    void serve() {
        std::unique_lock lock(mutex_);
        for (;;) {
            more_.wait(lock, [this] { return stop_ || next_ < count_; });
            if (stop_) return;
            const std::size_t i = next_++;
            lock.unlock();
            (*body_)(i);
            lock.lock();
            if (--left_ == 0) done_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable more_, done_;
    const std::function<void(std::size_t)>* body_ = nullptr;
    std::size_t next_ = 0, count_ = 0, left_ = 0;
    bool stop_ = false;
    std::vector<std::thread> threads_;
};
