/* SPDX-License-Identifier: MIT
 *
 * Where there is no libFuzzer: replays inputs, then makes some of its own, of random bytes or of kept inputs with bytes
 * changed: always the same for a seed.
 *
 *   fuzz_ROOM [--inputs N] [--minutes M] [--seed S] [--resume FILE] [--fresh] [FILE or FOLDER ...]
 *
 * With --fresh kept inputs are replayed only: what changes the hard ones asks for a hundred times the work of the rest.
 *
 * With --resume a campaign goes on where it was ended: FILE holds how many inputs were made and the generator's state,
 * and is written every SAVED inputs and at the end; --inputs counts those made before, too.
 *
 * An input that breaks a promise, crashes, or takes more than LONGEST seconds of computing is kept as
 * fuzz_failed.bytes; status 1.
 */
#define _XOPEN_SOURCE 700
#include "fuzz.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { SIZE = 768, KEPT = 512, LONGEST = 10, SAVED = 20000 };

static uint8_t kept[KEPT][SIZE];
static size_t sizes[KEPT], kept_count;
static bool fresh;
static uint8_t data[SIZE];
static size_t data_size;

static void keep_and_leave(int signal_number)
{
    const int file = open("fuzz_failed.bytes", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || write(file, data, data_size) < 0 || close(file) < 0) perror("fuzz_failed.bytes");
    signal(signal_number, SIG_DFL);
    if (signal_number == SIGABRT) _exit(1); /* a promise has said what it is */
    fprintf(stderr, "\n%s\n", signal_number == SIGVTALRM ? "takes too long" : strsignal(signal_number));
    fuzz_show(stderr);
    _exit(1);
}

static void run(void)
{
    const struct itimerval most = {{0, 0}, {LONGEST, 0}}, none = {{0, 0}, {0, 0}};
    setitimer(ITIMER_VIRTUAL, &most, NULL);
    LLVMFuzzerTestOneInput(data, data_size);
    setitimer(ITIMER_VIRTUAL, &none, NULL);
}

static void replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(2);
    }
    data_size = fread(data, 1, SIZE, file);
    fclose(file);
    run();
    if (kept_count < KEPT) {
        memcpy(kept[kept_count], data, data_size);
        sizes[kept_count++] = data_size;
    }
}

static int by_name(const struct dirent **a, const struct dirent **b) { return strcmp((*a)->d_name, (*b)->d_name); }

static void replay_all(const char *path)
{
    struct stat what;
    struct dirent **names;
    if (stat(path, &what) == 0 && !S_ISDIR(what.st_mode)) {
        replay(path);
        return;
    }
    const int count = scandir(path, &names, NULL, by_name);
    for (int i = 0; i < count; i++) {
        char inside[4096];
        if (names[i]->d_name[0] != '.' && snprintf(inside, sizeof inside, "%s/%s", path, names[i]->d_name) > 0)
            replay(inside);
        free(names[i]);
    }
    if (count >= 0) free(names);
}

/* splitmix64 (Steele, Lea, Flood 2014). */
static uint64_t draw(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static void invent(uint64_t *state)
{
    const uint64_t from = draw(state);
    if (kept_count && !fresh && from & 1) { /* up to eight bytes of a kept input changed */
        const size_t which = (size_t)(from >> 8) % kept_count;
        memcpy(data, kept[which], data_size = sizes[which]);
        for (uint64_t k = 1 + (from >> 4 & 7); k && data_size; k--)
            data[draw(state) % data_size] = (uint8_t)draw(state);
        return;
    }
    data_size = SIZE;
    for (size_t i = 0; i < SIZE; i += 8) {
        const uint64_t bits = draw(state);
        memcpy(data + i, &bits, 8);
    }
}

/* How many inputs a campaign has made, and the state it is in: as the file has them, if there is one. */
static void go_on(const char *path, unsigned long *made, uint64_t *state)
{
    FILE *file = path ? fopen(path, "r") : NULL;
    unsigned long long known = 0;
    if (file && fscanf(file, "%lu %llx", made, &known) == 2) *state = known;
    if (file) fclose(file);
}

/* Under another name first: whenever it is ended, one whole file is there. */
static void save(const char *path, unsigned long made, uint64_t state)
{
    char next[4096];
    if (!path || snprintf(next, sizeof next, "%s.next", path) >= (int)sizeof next) return;
    FILE *file = fopen(next, "w");
    const bool good = file && fprintf(file, "%lu %llx\n", made, (unsigned long long)state) > 0;
    if (!file || fclose(file) != 0 || !good || rename(next, path) != 0) {
        perror(path);
        exit(2);
    }
}

int main(int count, char **words)
{
    static const int caught[] = {SIGABRT, SIGVTALRM, SIGSEGV, SIGFPE, SIGILL, SIGBUS};
    unsigned long inputs = 0, made = 0;
    const char *resume = NULL;
    double minutes = 0;
    uint64_t state = 1;
    for (size_t i = 0; i < sizeof caught / sizeof *caught; i++) signal(caught[i], keep_and_leave);
    for (int i = 1; i < count; i++) {
        const bool more = i + 1 < count;
        if (more && strcmp(words[i], "--inputs") == 0)
            inputs = strtoul(words[++i], NULL, 10);
        else if (more && strcmp(words[i], "--minutes") == 0)
            minutes = strtod(words[++i], NULL);
        else if (more && strcmp(words[i], "--seed") == 0)
            state = strtoull(words[++i], NULL, 10);
        else if (more && strcmp(words[i], "--resume") == 0)
            resume = words[++i];
        else if (strcmp(words[i], "--fresh") == 0)
            fresh = true;
        else
            replay_all(words[i]);
    }
    go_on(resume, &made, &state);
    const time_t end = time(NULL) + (time_t)(60 * minutes);
    while (made < inputs || (minutes > 0 && time(NULL) < end)) {
        invent(&state);
        run();
        if (++made % SAVED == 0) save(resume, made, state);
    }
    save(resume, made, state);
    printf("%zu kept inputs, %lu made\n", kept_count, made);
    return 0;
}
