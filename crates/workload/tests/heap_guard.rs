//! Tests of the heap policy, which applies to the whole process. The tests are a separate program,
//! and hold a lock, so that no other test has a guard at the same time.

use sixfold_results::Policy;
use std::hint::black_box;
use std::sync::{Mutex, MutexGuard, PoisonError};

use sixfold_measure::pages::{self, HeapGuard};

fn alone() -> MutexGuard<'static, ()> {
    static TESTS: Mutex<()> = Mutex::new(());
    TESTS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn acquire(policy: Policy) -> HeapGuard {
    HeapGuard::acquire(policy).expect("no guard with another policy exists")
}

/// Returns whether this platform can keep pages and count page faults.
fn is_testable() -> bool {
    let report = acquire(Policy::Kept).report();
    report.policy == Policy::Kept && report.counts_faults
}

/// Size of a block that the heap keeps, in bytes. The heap of a test thread is 64 MiB at most.
const KEPT: usize = 48 << 20;
/// Size of a block that is larger than the heap of these tests, in bytes. By default, the C library
/// maps this block, and returns it when it is dropped.
const MAPPED: usize = 4 * KEPT;
/// Maximum number of page faults when a block is filled whose pages were kept. A fresh block causes
/// more, also with huge pages of 2 MiB.
const MAX_FAULTS: u64 = 16;

fn fill_a_block(bytes: usize) {
    drop(black_box(vec![1_u8; bytes]));
}

/// Returns the number of page faults of `work`.
fn faults_of(work: impl FnOnce()) -> u64 {
    let before = pages::faults();
    work();
    let faults = || Some(pages::faults()? - before?);
    faults().expect("page faults are counted")
}

/// Fills a block of `bytes` bytes twice, and returns the number of page faults of the second time.
fn faults_of_a_block(bytes: usize) -> u64 {
    fill_a_block(bytes);
    faults_of(|| fill_a_block(bytes))
}

#[test]
fn another_policy_is_refused_until_the_last_guard_is_dropped() {
    let _alone = alone();
    for [policy, other] in [Policy::ALL, [Policy::System, Policy::Kept]] {
        let [first, second] = [acquire(policy), acquire(policy)];
        assert_eq!(first.report(), second.report());
        for guard in [first, second] {
            let error = HeapGuard::acquire(other).expect_err("a guard exists");
            assert_eq!([error.requested, error.active], [other, policy]);
            let message = error.to_string();
            assert!(
                message.contains(&format!("`{other}` was requested"))
                    && message.contains(&format!("`{policy}` is active")),
                "{message}"
            );
            drop(guard);
        }
        drop(acquire(other));
    }
}

#[test]
fn pages_are_kept_until_the_last_guard_is_dropped() {
    let _alone = alone();
    if !is_testable() {
        return;
    }
    let [first, second] = [acquire(Policy::Kept), acquire(Policy::Kept)];
    for guard in [first, second] {
        assert!(faults_of_a_block(KEPT) <= MAX_FAULTS, "the pages were kept");
        drop(guard);
    }
    assert!(
        faults_of_a_block(MAPPED) > MAX_FAULTS,
        "the block was returned"
    );
}

#[test]
fn all_guards_report_that_memory_ran_out() {
    let _alone = alone();
    if !is_testable() {
        return;
    }
    let [first, second] = [acquire(Policy::Kept), acquire(Policy::Kept)];
    first.stop_keeping("memory ran out".into());
    for guard in [&first, &second] {
        assert!(!guard.keeps_pages());
        let report = guard.report();
        assert_eq!(report.policy, Policy::System);
        assert_eq!(report.reason.as_deref(), Some("memory ran out"));
    }
    assert!(
        faults_of_a_block(MAPPED) > MAX_FAULTS,
        "the block was returned"
    );

    // A later measurement may keep pages again, but the earlier two did not keep them all the time.
    let third = acquire(Policy::Kept);
    assert_eq!((third.keeps_pages(), third.report().reason), (true, None));
    assert!(!first.keeps_pages() && !second.keeps_pages());
    drop([first, second]);
    assert!(faults_of_a_block(KEPT) <= MAX_FAULTS, "the pages were kept");
    assert_eq!(third.report().policy, Policy::Kept);
}

#[test]
fn a_stop_without_kept_pages_changes_nothing() {
    let _alone = alone();
    let guard = acquire(Policy::System);
    guard.stop_keeping("memory ran out".into());
    assert_eq!(guard.report().reason, None);
    assert!(!guard.keeps_pages());
}

#[test]
fn nothing_is_reserved_if_pages_are_not_kept() {
    let _alone = alone();
    if !is_testable() {
        return;
    }
    assert!(faults_of(|| pages::reserve(KEPT)) <= MAX_FAULTS);
    let _guard = acquire(Policy::Kept);
    assert!(faults_of(|| pages::reserve(KEPT)) > MAX_FAULTS);
    assert!(
        faults_of(|| fill_a_block(KEPT)) <= MAX_FAULTS,
        "the pages were touched"
    );
}
