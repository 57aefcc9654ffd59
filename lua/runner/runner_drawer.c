/* SPDX-License-Identifier: MIT
 *
 * The drawer: a process made before the fence closes, which starts gnuplot when it is asked to; the runner itself
 * cannot. It is sent the three open files that gnuplot works with, and nothing else; it ends when the runner does.
 */
#define _GNU_SOURCE
#include "runner.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FILES = 3 }; /* commands, picture, complaints: gnuplot's descriptors 0, 1, 2 */

typedef union control { /* aligned as its header */
    struct cmsghdr header;
    char room[CMSG_SPACE(sizeof(int) * FILES)];
} control;

static const int ending[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXFSZ, SIGPIPE};

static void handle_all(void (*handler)(int))
{
    const struct sigaction action = {.sa_handler = handler};
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) sigaction(ending[i], &action, NULL);
}

static struct msghdr message_of(struct iovec *text, control *files)
{
    return (struct msghdr){
        .msg_iov = text, .msg_iovlen = 1, .msg_control = files->room, .msg_controllen = sizeof files->room};
}

/* ---- the drawer's side ---- */

static bool take_files(int link, unsigned long long *room, int files[FILES])
{
    control own = {0};
    struct iovec text = {room, sizeof *room};
    struct msghdr message = message_of(&text, &own);
    if (recvmsg(link, &message, 0) != (ssize_t)sizeof *room) return false;
    const struct cmsghdr *header =
        CMSG_FIRSTHDR(&message); /* NULL is unreachable: the runner alone sends, always files */
    if (!header || header->cmsg_len != CMSG_LEN(sizeof(int) * FILES)) return false;
    memcpy(files, CMSG_DATA(header), sizeof(int) * FILES);
    return true;
}

static _Noreturn void become_gnuplot(const int files[FILES], unsigned long long room)
{
    const struct rlimit limit = {(rlim_t)room, (rlim_t)room};
    setrlimit(RLIMIT_FSIZE, &limit);
    handle_all(SIG_DFL);
    for (int i = 0; i < FILES; i++)
        if (dup2(files[i], i) < 0) _exit(IMPACT_NO_PROGRAM);
    execlp("gnuplot", "gnuplot", "-d", "-", (char *)NULL);
    _exit(IMPACT_NO_PROGRAM);
}

static bool tell(int link, int number) { return send(link, &number, sizeof number, 0) == (ssize_t)sizeof number; }

static void serve(int link)
{
    unsigned long long room;
    int files[FILES];
    while (take_files(link, &room, files)) {
        int status = 0;
        const pid_t child = fork();
        if (child == 0) become_gnuplot(files, room);
        for (int i = 0; i < FILES; i++) close(files[i]);
        if (!tell(link, (int)child)) return;
        if (child > 0 && waitpid(child, &status, 0) != child) status = -1;
        const bool over = child > 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ;
        const int failed = over ? IMPACT_FILE_TOO_LARGE : -1;
        if (!tell(link, child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : failed)) return;
    }
}

bool impact_runner_start_drawer(impact_runner *runner)
{
    int link[2];
    runner->drawer_link = -1;
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, link) != 0) return false;
    runner->drawer = fork();
    if (runner->drawer == 0) {
        close(link[0]);
        handle_all(SIG_IGN); /* it ends with the runner, which hears them too */
        serve(link[1]);
        impact_runner_leave_folder(runner);
        _exit(0);
    }
    close(link[1]);
    if (runner->drawer > 0)
        runner->drawer_link = link[0];
    else
        close(link[0]);
    return runner->drawer > 0;
}

void impact_runner_end_drawer(impact_runner *runner)
{
    if (runner->drawer_link < 0) return;
    close(runner->drawer_link);
    runner->drawer_link = -1;
    while (waitpid(runner->drawer, NULL, 0) < 0 && errno == EINTR) continue;
}

/* ---- the runner's side ---- */

/* A number of the drawer's; gnuplot is ended when the runner is to end. */
static bool hear(const impact_runner *runner, int gnuplot, int *number)
{
    for (;;) {
        const ssize_t length = recv(runner->drawer_link, number, sizeof *number, 0);
        if (length == (ssize_t)sizeof *number) return true;
        if (length >= 0 || errno != EINTR) return false;
        if (gnuplot > 0 && (impact_runner_time_is_over() || impact_runner_signal())) kill(gnuplot, SIGKILL);
    }
}

int impact_runner_gnuplot(impact_runner *runner, int commands, int picture, int complaints)
{
    const int files[FILES] = {commands, picture, complaints};
    unsigned long long room = runner->quota.left;
    control own = {0};
    struct iovec text = {&room, sizeof room};
    struct msghdr message = message_of(&text, &own);
    struct cmsghdr *header = CMSG_FIRSTHDR(&message); /* NULL is unreachable: there is room */
    *header = (struct cmsghdr){.cmsg_len = CMSG_LEN(sizeof files), .cmsg_level = SOL_SOCKET, .cmsg_type = SCM_RIGHTS};
    memcpy(CMSG_DATA(header), files, sizeof files);
    int gnuplot = -1, code = -1;
    if (runner->drawer_link < 0 || sendmsg(runner->drawer_link, &message, 0) < 0) return -1;
    if (!hear(runner, -1, &gnuplot) || !hear(runner, gnuplot, &code)) return -1;
    /* the system may bound files by less than the quota */
    if (code == IMPACT_FILE_TOO_LARGE && lseek(picture, 0, SEEK_END) >= (off_t)room) runner->quota.spent = true;
    return code;
}
