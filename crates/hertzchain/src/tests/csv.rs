use super::*;
use serde_json::json;

#[test]
fn cells_that_hold_commas_or_quotes_are_quoted_and_what_is_no_number_is_empty() {
    let cells = [json!("a, \"b\""), json!(f64::INFINITY), json!(1.5e-7), json!(None::<f64>)];
    let cells = cells.into_iter().chain([json!(3_usize), json!(true)]);
    assert_eq!(table(["a", "b"], [cells]), "a,b\n\"a, \"\"b\"\"\",,1.5e-7,,3,true\n");
    let line = json!({ "name": "=1+1", "inner": { "value": [0, -1.5] } });
    let columns = columns("name,value=inner/value/1,none");
    assert_eq!(view(&[line], &columns), "name,value,none\n'=1+1,-1.5,\n");
}
