/* SPDX-License-Identifier: MIT
 *
 * The runner's command line, and what --help and --version say.
 */
#include "runner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void usage(FILE *file)
{
    fputs(
        "usage: impact SCRIPT.lua [options] [-- key=value ...]\n"
        "       impact view SCRIPT.lua|FILE.run [options]\n"
        "       impact gltf SCRIPT.lua|FILE.run [options]\n"
        "       impact sweep SCRIPT.lua [options] [-- key=value ...]\n"
        "       impact gather DIR [--hdf5]\n"
        "\n"
        "Runs the scene that the script returns and writes NAME.csv, NAME_events.csv and, when the scene has a plot "
        "and gnuplot\n"
        "is there, NAME.png. A script that returns nothing has done its work itself.\n"
        "view: writes NAME.html too, one page that shows the run in any browser.\n"
        "gltf: writes NAME.glb too, for Blender and others.\n"
        "sweep: runs the scenes of impact.sweep{...}, a row each; started again it goes on where it was ended.\n"
        "gather: puts the rows in DIR together as NAME.csv.\n"
        "\n"
        "  --out DIR         the output folder; made when needed (default: out)\n"
        "  --record          writes the recorded run, NAME.run, too: every state between events, for viewers\n"
        "  --save T FILE     saves the scene's state at time T, in seconds, as FILE in the output folder\n"
        "  --checkpoint S    saves it every S seconds, after an event, as NAME.save; gone when the run came to its "
        "end\n"
        "  --resume FILE     goes on from a state that was saved; the rows are those from there on\n"
        "  --report          what each method gets right of the scene, how sure that is and what it costs: a table,\n"
        "                    NAME_report.csv and NAME_report.png instead of a run\n"
        "  --seconds S       the report's time (default: 20)\n"
        "  --tolerance E     view, gltf: what keys may be off by, of a body's size and in rad (default: 3e-4 of gltf; "
        "1e-5 of a\n"
        "                    page too large to hold the record as it is)\n"
        "  --frame-rate F    gltf: frames a second of the scene in Blender that it is for (default: the first of "
        "24, 240, 2400\n"
        "                    and 24000 that holds the motion: Blender takes keys within a hundredth of a frame as "
        "one)\n"
        "  --verify          does the run again, each stretch between two events by another integrator: how far they "
        "differ\n"
        "  --pictures        beside NAME.png: flat panels as NAME.svg and NAME.pdf, those in space as a page, "
        "NAME.figure.html\n"
        "  --quiet           no progress, no closing summary\n"
        "  --max-memory MB   bounds all memory: of the script, the scenes and the files' buffers\n"
        "  --max-time S      bounds the time of the whole run, in seconds\n"
        "  --max-disk MB     bounds what is written, in all (default: 1024)\n"
        "  --fence           an error where the kernel cannot fence the program in\n"
        "  --trust           lets the script start programs, open any file and load C modules\n"
        "  --help            this text\n"
        "  --version         versions, and what this build holds\n"
        "\n"
        "of a sweep\n"
        "  -j N              threads (default: 1)\n"
        "  --shard I/N       the runs I, I + N, I + 2 N ... alone, 0 <= I < N\n"
        "  --mpi             runs are shared by all ranks of mpirun; then there is no fence of the kernel's\n"
        "  --hdf5            NAME.h5 too\n"
        "\n"
        "exit codes\n"
        "  0  done\n"
        "  1  the script has an error, or one of its functions that a run called: file, line and reason are told\n"
        "  2  the command line is wrong\n"
        "  3  the run failed: the integrator stopped, or no answer was found within the allowed work; every run of a\n"
        "     sweep; gather: rows are missing\n"
        "  4  an output could not be written\n"
        "  5  a limit was reached: --max-memory, --max-time, --max-disk, or the scene's max_events\n"
        "  6  done, but the energy account does not close, or --verify found another run: do not trust the digits\n"
        "  128 + N  ended by signal N: 130 by Ctrl-C, 129 by a hangup, 131 by SIGQUIT, 143 by SIGTERM\n"
        "\n"
        "Each but 0 comes with one line that says why, --quiet or not. A run that ends early keeps the rows it has as\n"
        "NAME.partial.csv and NAME_events.partial.csv, and the line says how far it came.\n",
        file);
}

static void version(void)
{
    printf("impact %s (%s; CVODE: %s, libccd: %s)\n", impact_version(), LUA_RELEASE,
           impact_has(IMPACT_PART_CVODE) ? "yes" : "no", impact_has(IMPACT_PART_CCD) ? "yes" : "no");
}

/* ---- the command line ---- */

static int wrong_usage(const char *format, const char *value)
{
    fputs("impact: ", stderr);
    fprintf(stderr, format, value);
    fputs("; see impact --help\n", stderr);
    return IMPACT_EXIT_USAGE;
}

/* A positive, finite number, all of the text; NaN otherwise. */
static double positive(const char *text)
{
    char *end = NULL;
    const double value = strtod(text, &end);
    return *text && !*end && value > 0 && isfinite(value) ? value : NAN;
}

/* A whole number of at least `least` that the text begins with; *end: what follows. -1: none. */
static int whole(const char *text, int least, const char **end)
{
    char *behind = NULL;
    const long value = *text >= '0' && *text <= '9' ? strtol(text, &behind, 10) : -1;
    *end = behind ? behind : text;
    return value >= least && value <= 1000000 ? (int)value : -1;
}

static int take_shard(impact_runner *runner, const char *value)
{
    const char *slash, *end = "";
    runner->shard = whole(value, 0, &slash);
    runner->shards = *slash == '/' ? whole(slash + 1, 1, &end) : -1;
    if (runner->shard >= 0 && runner->shard < runner->shards && !*end) return -1;
    return wrong_usage("--shard needs I/N with 0 <= I < N, got '%s'", value);
}

static int take_save_time(impact_runner *runner, const char *value)
{
    char *end = NULL;
    runner->save_at = strtod(value, &end);
    if (*end || !(runner->save_at >= 0 && runner->save_at < 1e300))
        return wrong_usage("--save needs a time and a file, '%s' is no time", value);
    return -1;
}

static int take_threads(impact_runner *runner, const char *value)
{
    const char *end;
    runner->threads = whole(value, 1, &end);
    return runner->threads > 0 && !*end ? -1 : wrong_usage("-j needs a number of threads, got '%s'", value);
}

/* Takes an option with a value, which loses the slashes at its end; an exit code, or -1. */
static int take_value(impact_runner *runner, const char *option, char *value)
{
    if (strcmp(option, "--out") == 0) {
        for (size_t end = strlen(value); end > 1 && value[end - 1] == '/'; end--) value[end - 1] = 0;
        return runner->directory = value, -1;
    }
    if (strcmp(option, "--resume") == 0) return runner->resume = value, -1;
    if (strcmp(option, "--save") == 0) return take_save_time(runner, value);
    if (strcmp(option, "--shard") == 0) return take_shard(runner, value);
    if (strcmp(option, "-j") == 0) return take_threads(runner, value);
    const double number = positive(value);
    if (!(number < 1e9)) return wrong_usage("'%s' is not a positive number below 1e9", value);
    if (strcmp(option, "--seconds") == 0)
        runner->report_seconds = number;
    else if (strcmp(option, "--tolerance") == 0)
        runner->tolerance = number;
    else if (strcmp(option, "--frame-rate") == 0)
        runner->frame_rate = number;
    else if (strcmp(option, "--max-time") == 0)
        runner->max_time = number;
    else if (strcmp(option, "--checkpoint") == 0)
        runner->checkpoint = number;
    else if (strcmp(option, "--max-disk") == 0)
        runner->max_disk_megabytes = number;
    else
        runner->max_megabytes = number, runner->max_memory = (size_t)(number * 1048576.0);
    return -1;
}

/* The option with a value that the word is, alone or as OPTION=VALUE; NULL: none. */
static const char *option_of(char *word, char **value)
{
    static const char *const options[] = {"--out",   "--max-memory", "--max-time",  "--max-disk",
                                          "--shard", "-j",           "--resume",    "--checkpoint",
                                          "--save",  "--seconds",    "--tolerance", "--frame-rate"};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        const size_t length = strlen(options[i]);
        if (strncmp(word, options[i], length) != 0 || (word[length] && word[length] != '=')) continue;
        *value = word[length] ? word + length + 1 : NULL;
        return options[i];
    }
    return NULL;
}

/* Sets the flag that the word names; false: none. */
static bool take_flag(impact_runner *runner, const char *word)
{
    const struct {
        const char *name;
        bool *flag;
    } flags[] = {{"--record", &runner->record}, {"--quiet", &runner->quiet},       {"--trust", &runner->trust},
                 {"--fence", &runner->fence},   {"--mpi", &runner->mpi},           {"--hdf5", &runner->hdf5},
                 {"--report", &runner->report}, {"--pictures", &runner->pictures}, {"--verify", &runner->verify}};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        if (strcmp(word, flags[i].name) == 0) return *flags[i].flag = true;
    return false;
}

/* The first word, when it is a command. */
static bool take_command(impact_runner *runner, const char *word)
{
    const bool view = strcmp(word, "view") == 0;
    if (view || strcmp(word, "gltf") == 0) {
        runner->shown = view ? "view" : "gltf";
        runner->ending = view ? "html" : "glb";
        return runner->record = true;
    }
    if (strcmp(word, "sweep") == 0) runner->command = IMPACT_COMMAND_SWEEP;
    if (strcmp(word, "gather") == 0) runner->command = IMPACT_COMMAND_GATHER;
    return runner->command != IMPACT_COMMAND_RUN;
}

/* What does not go together; an exit code, or -1. */
static int check_command(const impact_runner *runner)
{
    const bool sweep = runner->command == IMPACT_COMMAND_SWEEP, gather = runner->command == IMPACT_COMMAND_GATHER;
    if (!runner->script) return usage(stderr), IMPACT_EXIT_USAGE;
    if (runner->fence && runner->trust) return wrong_usage("%s and --trust exclude each other", "--fence");
    if (runner->fence && runner->mpi) return wrong_usage("%s and --mpi exclude each other", "--fence");
    if (!sweep && (runner->threads != 1 || runner->shards != 1 || runner->mpi || (runner->hdf5 && !gather)))
        return wrong_usage("%s, --shard, --mpi and --hdf5 are options of sweep", "-j");
    if (runner->save_name && !impact_runner_is_plain(runner->save_name))
        return wrong_usage("--save needs a time and a plain name of a file, got '%s'", runner->save_name);
    if ((sweep || gather) && (runner->save_name || runner->resume || runner->checkpoint > 0))
        return wrong_usage("%s, --checkpoint and --resume are of one scene's run; a sweep goes on by itself", "--save");
    if (sweep && runner->record)
        return wrong_usage("%s is no option of sweep: its `keep` says what is kept", "--record");
    if (runner->report &&
        (sweep || gather || runner->record || runner->save_name || runner->resume || runner->checkpoint > 0))
        return wrong_usage("%s makes no run: nothing that a run writes goes with it", "--report");
    if (runner->verify && (sweep || gather || runner->report || runner->resume))
        return wrong_usage("%s is of one scene's run from its start", "--verify");
    if (runner->report_seconds > 0 && !runner->report) return wrong_usage("%s is the report's: --report", "--seconds");
    if (runner->tolerance > 0 && !runner->shown) return wrong_usage("%s is view's and gltf's", "--tolerance");
    if (runner->frame_rate > 0 && (!runner->shown || strcmp(runner->shown, "gltf") != 0))
        return wrong_usage("%s is gltf's", "--frame-rate");
    if (sweep && runner->shards > 1 && runner->mpi) return wrong_usage("%s and --mpi exclude each other", "--shard");
    return -1;
}

/* -1: go on; else exit so. */
int impact_runner_read_command(int count, char **words, impact_runner *runner)
{
    bool first = true; /* no word but options so far */
    for (int i = 1; i < count; i++) {
        char *word = words[i], *value = NULL;
        const char *option = option_of(word, &value);
        if (option) {
            if (!value && i + 1 < count) value = words[++i];
            if (!value || !*value) return wrong_usage("%s needs a value", option);
            const int code = take_value(runner, option, value);
            if (code >= 0) return code;
            if (strcmp(option, "--save") == 0) runner->save_name = i + 1 < count ? words[++i] : "";
        } else if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
            return usage(stdout), IMPACT_EXIT_OK;
        } else if (strcmp(word, "--version") == 0) {
            return version(), IMPACT_EXIT_OK;
        } else if (strcmp(word, "--") == 0) {
            runner->arguments = &words[i + 1];
            break;
        } else if (take_flag(runner, word)) {
            continue;
        } else if (first && take_command(runner, word)) {
            first = false;
        } else if (word[0] == '-' && word[1]) {
            return wrong_usage("unknown option '%s'", word);
        } else if (runner->script) {
            return wrong_usage("one script at a time: '%s' is too many", word);
        } else {
            runner->script = word, first = false;
        }
    }
    return check_command(runner);
}
