// How the sanitizers behave in every fuzzing program unless the environment says otherwise.
// A target makes some thousand small allocations for each input: remembering where each
// came from, and keeping 256 MB of what was freed, took a third of the time. A finding is
// judged once more, with all frames.
extern "C" const char* __asan_default_options() {
  return "malloc_context_size=1:quarantine_size_mb=16:detect_stack_use_after_return=0";
}
