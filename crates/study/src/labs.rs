//! The results of measuring commands other than `sixfold study`, for the page of a report.

use serde::{Deserialize, Serialize};

use crate::environment::Environment;
use crate::growth::GrowthReport;
use crate::orders::OrdersReport;
use crate::pick::PickReport;
use crate::read::Results;
use crate::why::Why;

/// Results of the measuring commands other than `sixfold study`.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(default)]
pub struct Labs {
    /// Results of `sixfold orders`: one mesh with its elements in several orders.
    pub orders: Vec<OrdersReport>,
    /// Results of `sixfold growth`: one shape in several sizes.
    pub growth: Vec<GrowthReport>,
    /// Results of `sixfold why`: the bytes that queries read, compared with the times of the
    /// queries.
    pub why: Vec<Why>,
    /// Results of `sixfold pick`: rankings of backends for workloads.
    pub picks: Vec<PickReport>,
}

impl Labs {
    /// Counts the results that differ, for no known reason, from the results of other backends.
    pub fn mismatches(&self) -> usize {
        let orders = self.orders.iter().map(OrdersReport::mismatches);
        let growth = self.growth.iter().map(GrowthReport::mismatches);
        let why = self.why.iter().map(Why::mismatches);
        let picks = self.picks.iter().map(|pick| pick.mismatches.len());
        orders.chain(growth).chain(why).chain(picks).sum()
    }

    /// Returns true if one of the measurements was stopped early.
    pub fn interrupted(&self) -> bool {
        let orders = self.orders.iter().map(|orders| orders.interrupted);
        let growth = self.growth.iter().map(|growth| growth.interrupted);
        let why = self.why.iter().map(|why| why.interrupted);
        let picks = self.picks.iter().map(|pick| pick.interrupted);
        orders.chain(growth).chain(why).chain(picks).any(|cut| cut)
    }

    /// Iterates over the environments (machine, program and settings) of all results.
    pub fn environments(&self) -> impl Iterator<Item = &Environment> {
        let orders = self.orders.iter().map(|orders| &orders.environment);
        let growth = self.growth.iter().map(|growth| &growth.environment);
        let why = self.why.iter().filter_map(|why| why.environment.as_ref());
        let picks = self.picks.iter().map(|pick| &pick.environment);
        orders.chain(growth).chain(why).chain(picks)
    }

    /// Appends `others`.
    pub(crate) fn append(&mut self, mut others: Self) {
        self.orders.append(&mut others.orders);
        self.growth.append(&mut others.growth);
        self.why.append(&mut others.why);
        self.picks.append(&mut others.picks);
    }

    /// Adds the results of one command. Studies and collections are ignored.
    pub fn add(&mut self, results: Results) {
        match results {
            Results::Orders(orders) => self.orders.push(*orders),
            Results::Growth(growth) => self.growth.push(*growth),
            Results::Why(why) => self.why.push(*why),
            Results::Pick(pick) => self.picks.push(*pick),
            Results::Study(_) | Results::Collection(_) => {}
        }
    }
}
