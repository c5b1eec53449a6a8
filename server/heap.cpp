/// How the daemon's allocator, jemalloc, keeps freed memory. It reads this before main begins.
///
/// What a resting process has in memory shall not tell what its clients did last: freed pages go back to the system
/// after a second, from a thread of the allocator's own. Few arenas, for each keeps pages that are partly in use; what
/// threads allocate most they keep by themselves. glibc's allocator gives back whole pages alone when it is asked to,
/// and what a daemon at rest had grew by 2 to 6 % in half an hour (tests/RELIABILITY.md).
extern "C" const char* malloc_conf;
const char* malloc_conf = "background_thread:true,dirty_decay_ms:1000,muzzy_decay_ms:0,narenas:4";
