// SPDX-License-Identifier: MIT
// A forked process and the one it was forked from, at the ends of a pair of sockets. A program that is started would
// need a file that is found at run time, which a library does not have; and what it runs needs no memory of the size of
// a file.
#include "myriad/study/export/own_process.hpp"

#include <cerrno>
#include <csignal>
#include <exception>
#include <system_error>
#include <vector>

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "myriad/study/store/file_system.hpp"

namespace myriad::studies::inline MYRIAD_ABI {

namespace {

enum class word : std::int64_t { ask, done, failed, crashed };

/// What the process says. A text of `bytes` follows if it failed; an answer of `bytes` is due if it asks.
struct head {
    word said = word::ask;
    data_request wanted{};
    std::int64_t bytes = 0;
};

/// False if the other end is closed.
bool send_all(int socket, const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    while (size > 0) {
        const ssize_t sent = ::send(socket, from, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        from += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}
bool receive_all(int socket, void* data, std::size_t size) {
    auto* to = static_cast<std::byte*>(data);
    while (size > 0) {
        const ssize_t got = ::recv(socket, to, size, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to += got;
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------
// In the new process
// ---------------------------------------------------------------------------------------------------------------------

int end_of_child = -1;

/// The other process has ended: there is nobody to work for.
class alone : public std::exception {};

void say_crashed(int) {
    const head said{word::crashed, {errno}, 0};
    static_cast<void>(send_all(end_of_child, &said, sizeof said));
    ::_exit(1);
}

/// Ends the process at once: what the program does at its end is for the process that it was forked from.
[[noreturn]] void be_child(const std::function<void(const data_source& ask)>& work) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(signal, &say_crashed);
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is an error like others
    const data_source ask = [](const data_request& wanted, std::span<std::byte> answer) {
        const head said{word::ask, wanted, static_cast<std::int64_t>(answer.size())};
        if (!send_all(end_of_child, &said, sizeof said) || !receive_all(end_of_child, answer.data(), answer.size()))
            throw alone();
    };
    head said{word::done};
    std::string text;
    const auto fail = [&](const char* reason, int code) {
        text = reason;
        said = {word::failed, {code}, static_cast<std::int64_t>(text.size())};
    };
    try {
        work(ask);
    } catch (const alone&) {
        ::_exit(1);
    } catch (const file_error& failure) {
        fail(failure.what(), failure.code());
    } catch (const std::exception& failure) {
        fail(failure.what(), 0);
    } catch (...) {
        fail("an exception that has no text", 0);
    }
    if (send_all(end_of_child, &said, sizeof said)) send_all(end_of_child, text.data(), text.size());
    ::_exit(0);
}

// ---------------------------------------------------------------------------------------------------------------------
// Here
// ---------------------------------------------------------------------------------------------------------------------

error no_process(int code) {
    return error(statement_of("no process can be started: ", std::generic_category().message(code), host::cure,
                              "end other programs, or free memory, and try again"));
}

/// A process that is ended if it has not ended by itself.
class child {
public:
    explicit child(const std::function<void(const data_source& ask)>& work) {
        int ends[2];
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) < 0) throw no_process(errno);
        id_ = ::fork();
        if (id_ == 0) {
            ::close(ends[0]);
            end_of_child = ends[1];
            be_child(work);
        }
        const int code = errno;
        ::close(ends[1]);
        end_ = ends[0];
        if (id_ > 0) return;
        ::close(end_);
        throw no_process(code);
    }
    child(const child&) = delete;
    child& operator=(const child&) = delete;
    ~child() {
        ::close(end_);
        if (!told_) ::kill(id_, SIGKILL);
        // Nothing to wait for where the program has done so, or ignores SIGCHLD.
        while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }

    void serve(const data_source& source) {
        std::vector<std::byte> answer;
        head said;
        while (receive_all(end_, &said, sizeof said)) {
            told_ = said.said != word::ask;
            if (said.said == word::done) return;
            const auto code = static_cast<int>(said.wanted[0]);
            if (said.said == word::crashed) break_off(code);
            answer.resize(static_cast<std::size_t>(said.bytes));
            if (said.said == word::failed) {
                if (!receive_all(end_, answer.data(), answer.size())) break;
                throw process_error({reinterpret_cast<const char*>(answer.data()), answer.size()}, code);
            }
            source(said.wanted, answer);
            if (!send_all(end_, answer.data(), answer.size())) break;
        }
        break_off(0);
    }

private:
    [[noreturn]] static void break_off(int code) {
        throw process_error("a signal ended the process that did this", code);
    }

    pid_t id_ = -1;
    int end_ = -1;
    bool told_ = false;  // how it ended
};

}  // namespace

void in_own_process(const std::function<void(const data_source& ask)>& work, const data_source& source) {
    child(work).serve(source);
}

}  // namespace myriad::studies::inline MYRIAD_ABI
